"""How far long work is, in one line."""
import sys
import time


class Progress:
    """Replaces its line on a terminal; in a log, a line is added now and then."""

    def __init__(self, stream=None, what=''):
        self.stream = stream or sys.stderr
        self.what = what
        self.terminal = self.stream.isatty()
        self.start = time.monotonic()
        self.next = self.start + (0.5 if self.terminal else 30)

    def named(self, what):
        return Progress(self.stream, what)

    def update(self, done, total):
        now = time.monotonic()
        if done >= total and self.terminal and now >= self.start + 0.5:
            self.stream.write('\r\033[K')
        elif done < total and now >= self.next:
            text = '%s: %d %%, %d s left' % (self.what, 100 * done // total,
                                             (now - self.start) * (total - done) / max(1, done))
            self.stream.write(('\r\033[K%s' if self.terminal else '%s\n') % text)
            self.next = now + (0.1 if self.terminal else 30)
        self.stream.flush()
