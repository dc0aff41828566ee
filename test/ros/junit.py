"""Runs unit tests for rostest, and says in the result file which were skipped and why.

rosunit's own runner files a skipped test as passed and a failed subtest as nothing at all.
"""
import contextlib
import io
import re
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

RESULT_FLAG = '--gtest_output=xml:'


class _Tee(io.TextIOBase):
    """Writes to several streams."""

    def __init__(self, *streams):
        super().__init__()
        self._streams = streams

    def write(self, text):
        for stream in self._streams:
            stream.write(text)
        return len(text)

    def flush(self):
        for stream in self._streams:
            stream.flush()


class _Result(unittest.TextTestResult):
    """Keeps an element of the result file for each test."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.cases = []
        self._start = 0

    def startTest(self, test):
        super().startTest(test)
        self._start = time.monotonic()
        classname, name = test.id().rsplit('.', 1)
        self.cases.append(ElementTree.Element(
            'testcase', {'classname': classname.rsplit('.', 1)[-1], 'name': name}))

    def stopTest(self, test):
        self.cases[-1].set('time', '%.3f' % (time.monotonic() - self._start))
        super().stopTest(test)

    def _file(self, test, kind, text, error_type=''):
        if not self.cases or not isinstance(test, unittest.TestCase):
            # A class's or module's own set-up has failed.
            self.cases.append(ElementTree.Element(
                'testcase', {'classname': 'set-up', 'name': str(test), 'time': '0'}))
        text = re.sub('[^\t\n\r -~]', '?', text)
        element = ElementTree.SubElement(
            self.cases[-1], kind, {'type': error_type, 'message': text.strip().splitlines()[-1]})
        element.text = text

    def addError(self, test, err):
        super().addError(test, err)
        self._file(test, 'error', self.errors[-1][1], err[0].__name__)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._file(test, 'failure', self.failures[-1][1], err[0].__name__)

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            text = '%s\n%s: %s' % (subtest, err[0].__name__, err[1])
            self._file(test, 'failure', text, err[0].__name__)

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self._file(test, 'skipped', reason)


def run(cases):
    """Runs TestCase classes; exits with 1 when a test failed."""
    loader = unittest.TestLoader()
    suite = unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in cases)
    printed = io.StringIO()
    start = time.monotonic()
    with contextlib.redirect_stdout(_Tee(sys.stdout, printed)):
        result = unittest.TextTestRunner(stream=sys.stderr, verbosity=2,
                                         resultclass=_Result).run(suite)
    root = ElementTree.Element('testsuite', {
        'name': cases[0].__name__, 'tests': str(result.testsRun),
        'failures': str(len(result.failures)), 'errors': str(len(result.errors)),
        'skipped': str(len(result.skipped)), 'time': '%.3f' % (time.monotonic() - start)})
    root.extend(result.cases)
    ElementTree.SubElement(root, 'system-out').text = printed.getvalue()
    for argument in sys.argv:
        if argument.startswith(RESULT_FLAG):
            ElementTree.ElementTree(root).write(argument[len(RESULT_FLAG):], encoding='utf-8',
                                                xml_declaration=True)
    sys.exit(0 if result.wasSuccessful() else 1)
