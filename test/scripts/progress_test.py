#!/usr/bin/python3
"""The line that says how far long work is: on a terminal, in a log, in a quiet log."""
import io
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
sys.dont_write_bytecode = True

from vwd_loads import progress  # noqa: E402 (the folder has to be known first)


class Stream(io.StringIO):
    def __init__(self, terminal):
        super().__init__()
        self.terminal = terminal

    def isatty(self):
        return self.terminal


class Line(unittest.TestCase):
    def setUp(self):
        self.now = 100.0
        true = progress.time
        progress.time = self  # a clock
        self.addCleanup(setattr, progress, "time", true)

    def monotonic(self):
        return self.now

    def work(self, terminal, seconds=100, **options):
        stream = Stream(terminal)
        line = progress.Progress(stream, **options).named("counting")
        for i in range(1, 101):
            self.now += seconds / 100
            line.update(i, 100)
        return stream.getvalue()

    def test_on_a_terminal_one_line_is_replaced_and_goes(self):
        said = self.work(True)
        self.assertTrue(said.startswith("\r\033[Kcounting: 1 %, 99 s left\r\033[Kcounting: 2 %"), said[:60])
        self.assertTrue(said.endswith("counting: 99 %, 1 s left\r\033[K"), said[-60:])
        self.assertNotIn("\n", said)

    def test_short_work_says_nothing(self):
        self.assertEqual(self.work(True, 0.4), "")
        self.assertEqual(self.work(False, 25), "")

    def test_in_a_log_a_line_is_added_now_and_then(self):
        self.assertEqual(self.work(False), "counting: 30 %, 70 s left\ncounting: 60 %, 40 s left\n"
                                           "counting: 90 %, 10 s left\n")
        self.assertEqual(self.work(False, quiet=True), "")

    def test_stages_are_for_terminals(self):
        for terminal, wanted in ((True, "\r\033[Kfitting ...\r\033[K"), (False, "")):
            stream = Stream(terminal)
            line = progress.Progress(stream)
            line.stage("fitting")
            line.clear()
            line.clear()
            self.assertEqual(stream.getvalue(), wanted)


if __name__ == "__main__":
    unittest.main()
