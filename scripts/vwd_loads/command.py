"""The command line."""
import argparse
import os
import sys

BAD_INPUT, BAD_MACHINE = 1, 2  # exit status: the results are at fault, or what they are read and written with
PACKAGES = {'numpy': 'python3-numpy', 'scipy': 'python3-scipy', 'matplotlib': 'python3-matplotlib'}

DESCRIPTION = """Makes a load report of results of inverse_dynamics_offline, as .npz or CSV: peaks with their
postures, rms, percentiles, radial and axial forces, tilting moments, equivalent bearing loads, cycles, spectra,
efforts against limits. Writes report.html, report.md with figures/, loads.csv and sums.json into a folder."""


def parse(words):
    parser = argparse.ArgumentParser(prog='load_report.py', description=DESCRIPTION)
    parser.add_argument('results', nargs='+', metavar='RESULTS',
                        help='results of a motion; with --merge: folders of reports, or files with a list of '
                        'them behind @')
    parser.add_argument('--output', required=True, metavar='DIR', help='folder of the report')
    parser.add_argument('--mechanism', metavar='FILE', help='mechanism.json as inverse_dynamics_offline --report '
                        'writes it; an .npz has it in it')
    parser.add_argument('--woehler', type=_positive, metavar='M',
                        help='Wöhler exponent of the equivalent range (default: 5; welded steel: 3)')
    parser.add_argument('--max-gap', type=_positive, metavar='S',
                        help='nothing is assumed across longer gaps (default: as the results say, or 0.25; at '
                        'least five usual spacings)')
    parser.add_argument('--figures-only', action='store_true', help='only loads.csv and sums.json')
    parser.add_argument('--merge', action='store_true', help='one report of many, from their sums.json; '
                        'reports that are missing or broken are listed')
    return parser.parse_args(words)


def _positive(text):
    value = float(text)
    if not 0 < value < float('inf'):
        raise argparse.ArgumentTypeError('%r is not a positive number' % text)
    return value


def main(words):
    arguments = parse(words)
    from vwd_loads.errors import ReportError
    try:
        run(arguments)
    except ImportError as error:
        package = PACKAGES.get((error.name or '').split('.')[0], 'python3-' + str(error.name))
        print('load_report.py: error: %s; install it: apt install %s' % (error, package), file=sys.stderr)
        return BAD_MACHINE
    except (ReportError, OSError) as error:
        print('load_report.py: error: %s' % ' '.join(str(error).split()), file=sys.stderr)
        return BAD_INPUT if isinstance(error, ReportError) else BAD_MACHINE
    return 0


def check_for_merge(arguments):
    """Refuses what has no say in a report of reports."""
    from vwd_loads.errors import ReportError
    for option, given in (('--woehler', arguments.woehler), ('--max-gap', arguments.max_gap),
                          ('--mechanism', arguments.mechanism), ('--figures-only', arguments.figures_only)):
        if given:
            raise ReportError('%s is of the report of one motion and cannot be used with --merge' % option)


def run(arguments):
    if arguments.merge:
        check_for_merge(arguments)
    from vwd_loads.errors import ReportError
    from vwd_loads.loads import WOEHLER, Settings
    from vwd_loads.mechanism import mechanism_of, read_mechanism
    from vwd_loads.merged import write_merged
    from vwd_loads.progress import Progress
    from vwd_loads.report import Report
    from vwd_loads.table import read_table
    if not arguments.figures_only:
        from vwd_loads import plots  # noqa: F401  (what is missing is to be said before long work)
    if not arguments.figures_only and not arguments.merge:
        import scipy.signal  # noqa: F401
    if arguments.merge:
        print(write_merged(arguments.results, arguments.output))
        return
    if len(arguments.results) > 1:
        raise ReportError('%d results; a report is of one, or with --merge of reports'
                          % len(arguments.results))
    table = read_table(arguments.results[0])
    said = read_mechanism(arguments.mechanism) if arguments.mechanism else table.mechanism
    settings = Settings(arguments.woehler or WOEHLER, arguments.max_gap)
    report = Report(table, mechanism_of(table, said), settings, arguments.output, Progress())
    if arguments.figures_only:
        report.write_figures_only()
        return
    report.write()
    print('report: %s' % os.path.join(arguments.output, 'report.html'))
