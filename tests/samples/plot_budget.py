# plot_budget.py  samples/demo/plot_budget.py: pictures from a report, one line for anything else.
import json
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "samples/demo/plot_budget.py"
PNG_START = b"\x89PNG\r\n\x1a\n"


def frame(index, over=False):
    return {"time_s": index / 60, "total_us": 5000 if over else 480 + index, "schedule_us": 2, "drive_us": 90,
            "tissue_us": 700, "rods_us": 40, "publish_us": 60, "network": 3, "modal": 0, "extrapolated": 1,
            "skinning": 0, "cut": int(over),
            "first": {"tier": "extrapolated" if index > 40 else "network", "blend": 1.0}}


def report(**changes):
    content = {"character": "creature", "instances": 4, "fps": 60.0, "threads": 2, "budget_us": 500.0,
               "frames": [frame(i, over=i % 20 == 7) for i in range(60)]}
    return {**content, **changes}


class PlotBudget(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.input = Path(self.folder.name) / "report.json"
        self.output = Path(self.folder.name) / "budget.png"

    def plot(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True)

    def refused(self, *arguments, words):
        result = self.plot(*arguments)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def svg_text(self):
        return " ".join(xml.etree.ElementTree.parse(self.output.with_suffix(".svg")).getroot().itertext())

    def test_unusable_reports_are_refused_in_one_line(self):
        self.refused(self.input, words=["report.json", "sinew-demo"])
        for content in ("not json", "[]", '{"frames": [{"time": 1}]}'):
            self.input.write_text(content)
            self.refused(self.input, words=["report.json", "sinew-demo"])

    def test_place_that_cannot_be_written_is_refused(self):
        self.input.write_text(json.dumps(report()))
        self.refused(self.input, "-o", Path(self.folder.name) / "none/budget.png", words=["budget.png"])

    def test_picture_shows_stages_budget_tiers_and_what_is_beyond_it(self):
        self.input.write_text(json.dumps(report()))
        result = self.plot(self.input, "-o", self.output)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.output.read_bytes()[:8], PNG_START)
        text = self.svg_text()
        for word in ("schedule", "drive", "tissue", "publish", "budget 500", "extrapolated", "cut short (3)",
                     "higher: 3, worst 5000", "simulated time (s)"):
            self.assertIn(word, text)

    def test_report_without_budget_and_with_errors_is_plotted(self):
        frames = [{**frame(i), "error_mm": {"skinning": 8.0, "sinew": 2.0}} for i in range(60)]
        self.input.write_text(json.dumps(report(budget_us=None, frames=frames)))
        self.assertEqual(self.plot(self.input, "-o", self.output).returncode, 0)
        for word in ("mean error (mm)", "then extrapolated"):
            self.assertIn(word, self.svg_text())
        self.assertNotIn("budget", self.svg_text())

    def test_same_report_gives_the_same_bytes(self):
        self.input.write_text(json.dumps(report()))
        pictures = []
        for _ in range(2):
            self.assertEqual(self.plot(self.input, "-o", self.output).returncode, 0)
            pictures.append((self.output.read_bytes(), self.output.with_suffix(".svg").read_bytes()))
        self.assertEqual(pictures[0], pictures[1])


if __name__ == "__main__":
    unittest.main()
