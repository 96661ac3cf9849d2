"""One line that is drawn over itself on a terminal; elsewhere nothing."""
import sys
import time

REDRAWN_S = 0.2


class ProgressLine:
    def __init__(self, stream=None):
        self.stream = stream or sys.stderr
        self.drawn_s = 0.0

    def update(self, text):
        """text: a string, or what makes one."""
        now = time.monotonic()
        if not self.stream.isatty() or now - self.drawn_s < REDRAWN_S:
            return
        self.drawn_s = now
        print(f"\r\x1b[K{text() if callable(text) else text}", end="", file=self.stream, flush=True)

    def clear(self):
        if self.stream.isatty():
            print("\r\x1b[K", end="", file=self.stream, flush=True)
