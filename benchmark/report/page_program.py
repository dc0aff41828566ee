"""What the programs that write pages have in common."""
import argparse
import pathlib
import sys

from report_data import ReportError


def progress(what):
    """One line of a terminal, which None wipes out."""
    if sys.stderr.isatty():
        print('\r\033[K' + (what or ''), end='', file=sys.stderr, flush=True)


def run(name, description, write, add_options=None):
    """Parses FOLDER and what add_options adds, and calls write with them. Returns the exit
    status."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', metavar='FOLDER', type=pathlib.Path)
    if add_options:
        add_options(parser)
    try:
        write(parser.parse_args())
    except (ReportError, OSError) as problem:
        progress(None)
        print('%s: %s' % (name, problem), file=sys.stderr)
        return 1
    progress(None)
    return 0
