"""Ctrl-C as a wish: work ends at its next step, and what is best so far is kept."""
import signal
import sys


class Stop:
    """`asked` turns true with the first SIGINT or SIGTERM; the second one raises KeyboardInterrupt."""

    def __init__(self):
        self.asked = False

    def listen(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._ask)
        return self

    def _ask(self, number, frame):
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
        print("\nsinew-train: stops and keeps the best so far; again to give up", file=sys.stderr)
