#!/usr/bin/python3
"""Loads of one recording, for the workflow.

Usage: one_motion.py --folder DIR --report LOAD_REPORT [--pages] [--keep] [--woehler M] -- TOOL OPTIONS...

Writes what the tool says to DIR/log.txt and, last of all, DIR/outcome.txt: "done", or "failed: " and why. A
recording that cannot be read or computed is such an outcome. What is no fault of the recording (a signal, no
space, a missing package, wrong usage) ends this program with an error, so that it is tried again.
"""
import argparse
import os
import shutil
import subprocess
import sys

ERROR = ': error: '
BAD_INPUT = 1  # exit status of the tools; 2 and others are no fault of the recording


class Failed(Exception):
    """Why a recording has no loads."""


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--folder', required=True)
    parser.add_argument('--report', required=True)
    parser.add_argument('--woehler', default='5')
    parser.add_argument('--pages', action='store_true')
    parser.add_argument('--keep', action='store_true')
    parser.add_argument('tool', nargs='+')
    return parser.parse_args()


def run(words, log, folder):
    """Runs a program. Raises Failed for a fault of the recording, ends this program for others."""
    with open(log, 'ab') as file:
        place = file.tell()
        status = subprocess.call(words, stdin=subprocess.DEVNULL, stdout=file, stderr=file)
    if status == 0:
        return
    with open(log, encoding='utf-8', errors='replace') as file:
        file.seek(place)
        lines = file.read().splitlines()
    said = next((line.split(ERROR, 1)[1] for line in reversed(lines) if ERROR in line), '')
    # What is said of a file in the folder is about what is written there, as where there is no space.
    if status == BAD_INPUT and said and folder + os.sep not in said:
        raise Failed(said)
    reason = said or ('killed by signal %d' % -status if status < 0 else 'status %d' % status)
    sys.exit('%s: %s' % (folder, reason))


def compute(arguments):
    folder = arguments.folder
    log, results = os.path.join(folder, 'log.txt'), os.path.join(folder, 'results.npz')
    run(arguments.tool + ['--axes', 'child', '--positions', '--output', results], log, folder)
    words = [arguments.report, results, '--output', folder, '--woehler', arguments.woehler]
    try:
        run(words + ([] if arguments.pages else ['--figures-only']), log, os.path.join(folder, 'sums'))
    finally:
        if not arguments.keep:
            os.remove(results)


def main():
    arguments = parse()
    shutil.rmtree(arguments.folder, ignore_errors=True)
    os.makedirs(arguments.folder)
    outcome = 'done'
    try:
        compute(arguments)
    except Failed as reason:
        outcome = 'failed: %s' % reason
    part = os.path.join(arguments.folder, 'outcome.part')
    with open(part, 'w', encoding='utf-8') as file:
        file.write(outcome + '\n')
    os.rename(part, os.path.join(arguments.folder, 'outcome.txt'))


if __name__ == '__main__':
    main()
