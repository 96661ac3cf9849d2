"""How the whole wall time is divided into simulation, training and evaluation."""
import time

SIMULATION_SHARE = 0.6  # of the whole; training takes what evaluation leaves of the rest
EVALUATION_S = 1.0  # besides bakes: judging, files


class TimeBudget:
    """Times are of the monotonic clock, in seconds. bake_s, motion_s: measured, how long a bake and the truth
    of a motion take."""

    def __init__(self, minutes, clock=time.monotonic):
        self.clock, self.began_s, self.whole_s = clock, clock(), 60 * minutes
        self.bake_s, self.motion_s = 0.0, 2.0

    def left_s(self):
        return max(0.0, self.began_s + self.whole_s - self.clock())

    def simulation_end_s(self):
        return self.began_s + SIMULATION_SHARE * self.whole_s

    def training_end_s(self):
        """Evaluation bakes the tuned network, and the best one with its errors measured on short motions."""
        return self.began_s + self.whole_s - 2 * self.bake_s - self.motion_s - EVALUATION_S


def in_words(seconds):
    """9 s, 4 min 10 s."""
    whole = max(0, round(seconds))
    return f"{whole // 60} min {whole % 60:02d} s" if whole >= 60 else f"{whole} s"
