"""Ground truth of motions, several at once, until a time; what is there already is taken as it is."""
import os
import subprocess
import time
from dataclasses import dataclass

from ..data.dataset import SPLITS
from ..data.generate import is_done, truth_command, what_is_wrong
from ..files.safetensors import BadData
from ..files.write_file import remove_left_parts

POLL_S = 0.02
MOST_FAILURES = 6  # in a row from the start: this character cannot be simulated


@dataclass
class Running:
    job: object
    process: subprocess.Popen
    began_s: float
    path: str

    def end(self):
        self.process.kill()
        self.process.communicate()
        remove_left_parts(self.path)


class Simulation:
    """done, failed: job -> its file, why there is none. seconds: of the wall clock, of each one finished."""

    def __init__(self, baker, folder, processes, stop, report=lambda simulation: None):
        self.baker, self.folder, self.processes = baker, folder, processes
        self.stop, self.report = stop, report
        self.done, self.failed, self.seconds, self.running = {}, {}, [], []

    def run(self, jobs, end_s):
        """In order until end_s, of the monotonic clock, and on until every split has a motion. Throws BadData
        where nothing can be simulated."""
        self.waiting = []
        for job in jobs:
            path = os.path.join(self.folder, job.file)
            if is_done(path, job):
                self.done[job] = path
            else:
                self.waiting.append(job)
        try:
            while not self.stop.asked and (self._start_some(end_s) or self.running):
                time.sleep(POLL_S)
                self._collect()
                self.report(self)
        finally:
            for one in self.running:
                one.end()
            self.running = []
        return self

    def mean_s(self):
        return sum(self.seconds) / len(self.seconds) if self.seconds else 0.0

    def of_split(self, split):
        """Files of a split's motions, by their jobs."""
        return {job: path for job, path in self.done.items() if job.split == split}

    def _lacking(self):
        """Splits with no motion that is there or on its way."""
        have = {j.split for j in self.done} | {one.job.split for one in self.running}
        return [s for s in SPLITS if s not in have]

    def _next(self, end_s):
        lacking = self._lacking()
        needed = next((job for job in self.waiting if job.split in lacking), None)
        if needed:
            return needed
        in_time = time.monotonic() + self.mean_s() <= end_s
        return self.waiting[0] if self.waiting and in_time else None

    def _start_some(self, end_s):
        """Whether any was started."""
        started = False
        while len(self.running) < self.processes:
            job = self._next(end_s)
            if job is None:
                break
            self.waiting.remove(job)
            self.running.append(self._start(job))
            started = True
        return started

    def _start(self, job):
        path = os.path.join(self.folder, job.file)
        baker = self.baker
        command = truth_command(baker.program, baker.character, baker.recipe, job, path)
        quiet = dict(stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        process = subprocess.Popen(command, start_new_session=True, **quiet)  # Ctrl-C is ours to act on
        return Running(job, process, time.monotonic(), path)

    def _collect(self):
        for one in [r for r in self.running if r.process.poll() is not None]:
            self.running.remove(one)
            said = one.process.communicate()[1].strip().splitlines()
            if one.process.returncode:
                why = said[-1] if said else f"exit code {one.process.returncode}"
            else:
                why = what_is_wrong(one.path)
            if why:
                self.failed[one.job] = why
                self._check_failures()
            else:
                self.done[one.job] = one.path
                self.seconds.append(time.monotonic() - one.began_s)

    def _check_failures(self):
        if not self.done and len(self.failed) >= MOST_FAILURES:
            job, why = next(iter(self.failed.items()))
            raise BadData(f"{self.baker.character}: {job.motion} cannot be simulated: {why}")
