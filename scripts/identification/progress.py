"""One line on a terminal that says how far long work is; nothing in a log."""
import sys
import time


class Progress:
    def __init__(self):
        self._stream = sys.stderr
        self._terminal = sys.stderr.isatty()
        self._start = self._next = time.monotonic() + 0.5
        self._shown = False

    def __call__(self, what, done=None, total=None):
        now = time.monotonic()
        if not self._terminal or now < self._next:
            return
        part = '' if not total else ': %d %%' % (100 * done // total)
        self._stream.write('\r\033[K%s%s' % (what, part))
        self._stream.flush()
        self._next = now + 0.1
        self._shown = True

    def stage(self, what):
        """The beginning of work that may take long."""
        if self._terminal:
            self._stream.write('\r\033[K%s ...' % what)
            self._stream.flush()
            self._shown = True

    def clear(self):
        if self._shown:
            self._stream.write('\r\033[K')
            self._stream.flush()
        self._shown = False
