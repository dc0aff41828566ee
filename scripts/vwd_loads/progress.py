"""How far long work is, in one line; of every program here."""
import sys
import time

PATIENCE = 0.5  # s, before anything is shown
OFTEN, SELDOM = 0.1, 30  # s between lines on a terminal and in a log


class Progress:
    """Replaces its line on a terminal; in a log, a line is added now and then, unless it is `quiet` there."""

    def __init__(self, stream=None, what='', quiet=False):
        self.stream = stream or sys.stderr
        self.what = what
        self.quiet = quiet
        self.terminal = self.stream.isatty()
        self.start = time.monotonic()
        self.next = self.start + (PATIENCE if self.terminal else SELDOM)
        self.shown = False

    def named(self, what):
        return Progress(self.stream, what, self.quiet)

    def update(self, done, total):
        now = time.monotonic()
        if done >= total:
            self.clear()
        elif now >= self.next:
            self._show('%s: %d %%, %d s left' % (self.what, 100 * done // total,
                                                 (now - self.start) * (total - done) / max(1, done)))
            self.next = now + (OFTEN if self.terminal else SELDOM)

    def stage(self, what):
        """The beginning of work whose length is not known; on a terminal only."""
        if self.terminal:
            self._show(what + ' ...')

    def clear(self):
        if self.shown and self.terminal:
            self.stream.write('\r\033[K')
            self.stream.flush()
        self.shown = False

    def _show(self, text):
        if self.quiet and not self.terminal:
            return
        self.stream.write(('\r\033[K%s' if self.terminal else '%s\n') % text)
        self.stream.flush()
        self.shown = True
