#!/usr/bin/python3
"""Sums JUnit result files and prints every failure by name, then one line "N passed, N failed".

Usage: count_tests.py FILE_OR_FOLDER ...
The exit code is not 0 when a test failed, a file is not a result file, or there is no test at all.
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def result_files(arguments):
    for argument in arguments:
        path = pathlib.Path(argument)
        if path.is_dir():
            yield from sorted(path.rglob('*.xml'))
        else:
            yield path


def verdict(case):
    """The kind of result of a <testcase>, and its message."""
    for kind in ('failure', 'error'):
        element = case.find(kind)
        if element is not None:
            text = element.get('message') or (element.text or '').strip()
            return 'failed', text.splitlines()[0] if text else ''
    if case.find('skipped') is not None or case.get('status') == 'notrun':
        return 'skipped', ''
    return 'passed', ''


def count(path, totals):
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError) as problem:
        print('FAILED  %s: %s' % (path, problem))
        totals['failed'] += 1
        return
    # rostest lists each test program once more; the tests that it ran are in the program's own file.
    is_summary = path.name.startswith('rostest-')
    for case in root.iter('testcase'):
        kind, message = verdict(case)
        if is_summary and kind != 'failed':
            continue
        totals[kind] += 1
        if kind == 'failed':
            name = '.'.join(filter(None, (case.get('classname'), case.get('name'))))
            print('FAILED  %s: %s' % (name, message[:200]))


def main(arguments):
    if not arguments or arguments[0] in ('-h', '--help'):
        print(__doc__)
        return 2
    totals = {'passed': 0, 'failed': 0, 'skipped': 0}
    for path in result_files(arguments):
        count(path, totals)
    if not sum(totals.values()):
        print('FAILED  no test result in %s' % ' '.join(arguments))
        totals['failed'] = 1
    line = '%(passed)d passed, %(failed)d failed' % totals
    if totals['skipped']:
        line += ', %(skipped)d skipped' % totals
    print(line)
    return 1 if totals['failed'] else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
