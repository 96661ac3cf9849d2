"""An evaluation of exported weights, its table of all figures and its short page."""
import contextlib
import csv
import io
import json
import os
import unittest
from unittest import mock

import support

support.leave_without_torch()
from train.cli import main as trainer  # noqa: E402
from train.judge import ablate, baselines, evaluate, page  # noqa: E402

WEIGHTS = str(support.ROOT / "assets/weights/creature.safetensors")
MOST_WORDS = 450


def read_csv(path):
    with open(path) as file:
        return {tuple(r[k] for k in page.HEAD[:-1]): r["value"] for r in csv.DictReader(file)}


class Page(support.Folder):
    def evaluate(self, run, *options):
        """The exit code of `evaluate` on made-up data. Plain models are fitted in few iterations: none is judged here."""
        os.makedirs(self.place("data"))
        support.write_data_set(self.place("data"), train_count=1, validation=1, test=1, ticks=60)
        command = ["evaluate", self.place("data"), "--run", f"network={run}", "--out", self.place("page"), *options]
        with (
            mock.patch.object(evaluate, "STILL_TICKS", 10),
            mock.patch.object(baselines, "_fit", lambda *arguments: None),
            contextlib.redirect_stdout(io.StringIO()),
        ):
            return trainer(command)

    def written(self):
        return sorted(os.listdir(self.place("page")))

    def test_exported_weights_are_judged_without_their_run(self):
        self.assertEqual(self.evaluate(WEIGHTS), 0)
        with open(self.place("page/metrics.json")) as file:
            metrics = json.load(file)
        self.assertEqual(metrics["models"]["network"]["parameters"], 4331)
        self.assertNotIn("training.png", self.written())  # its curve lies in the run
        rows = read_csv(self.place("page/errors.csv"))
        at = metrics["bodies"][support.BODY]["roll_out"]["50"]
        self.assertEqual(rows["roll_out", support.BODY, "network", "50", "ratio"], str(at["network"]["ratio"]))
        self.assertEqual(rows["roll_out", support.BODY, "skinning", "50", "ratio"], "1.0")

    def test_the_page_has_one_short_table(self):
        self.assertEqual(self.evaluate(WEIGHTS), 0)
        with open(self.place("page/README.md")) as file:
            text = file.read()
        self.assertLessEqual(len(text.split()), MOST_WORDS)
        rows = [line.split(" | ")[0].strip("| ") for line in text.splitlines() if line.startswith("|")]
        spring = "best spring (one spring per "
        self.assertEqual([rows[0], rows[2], rows[3][: len(spring)], *rows[4:]], ["body, ticks", "skinning", spring, "modal base", "network `network`"])
        self.assertIn("[every figure](errors.csv)", text)
        self.assertNotIn("confirmation", text)

    def test_figures_of_later_motions_go_to_the_page_that_they_confirm(self):
        self.assertEqual(self.evaluate(WEIGHTS, "--no-page"), 0)
        self.assertEqual(set(self.written()), {"metrics.json", "errors.csv"})
        os.rename(self.place("page"), self.place("confirmation"))
        os.makedirs(self.place("page"))
        os.rename(self.place("confirmation"), self.place("page/confirmation"))
        with open(self.place("page/confirmation/metrics.json")) as file:
            metrics = json.load(file)
        self.assertIn("[figures](confirmation/errors.csv)", page.page(metrics, self.place("page")))

    def test_weights_that_are_not_there_are_refused_by_name(self):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.assertEqual(self.evaluate(self.place("none.safetensors")), 2)
        self.assertIn("none.safetensors: No such file", said.getvalue())
        self.assertFalse(os.path.exists(self.place("page")))


class Ablations(support.Folder):
    def test_variants_are_compared_in_a_table_that_an_evaluation_page_links(self):
        os.makedirs(self.place("data"))
        support.write_data_set(self.place("data"), train_count=1, validation=1, test=1, ticks=60)
        train = lambda variants, *rest: {name: evaluate.Network(WEIGHTS) for name in list(variants)[:2]}
        with mock.patch.object(ablate, "train_variants", train), mock.patch.object(ablate, "TICKS", (50,)):
            ablate.ablate(self.place("data"), support.BODY, self.place("work"), self.place("page"), 1, 1)
        self.assertEqual(sorted(os.listdir(self.place("page"))), ["ablations.csv", "ablations.json", "ablations.png"])
        with open(self.place("page/ablations.csv")) as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([r["variant"] for r in rows], ["as shipped", "no modal base"])
        self.assertEqual(rows[0]["parameters"], "4331")
        self.assertGreater(float(rows[0]["error_ratio_50_ticks"]), 0)
        with open(support.ROOT / "assets/evaluation/metrics.json") as file:
            self.assertIn("[ablations](ablations.csv)", page.page(json.load(file), self.place("page")))


class Figures(unittest.TestCase):
    def test_every_number_of_the_metrics_is_in_the_table(self):
        with open(support.ROOT / "assets/evaluation/metrics.json") as file:
            metrics = json.load(file)
        rows = list(page.error_rows(metrics))
        self.assertEqual(len(rows), len({r[:5] for r in rows}))

        def numbers(value):
            values = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
            return sum(map(numbers, values)) if values else isinstance(value, (int, float)) and not isinstance(value, bool)

        counted = numbers(metrics["bodies"]) + numbers(metrics.get("known_motions", {}))
        self.assertEqual(sum(r[0] not in ("network", "left_alone") for r in rows), counted)


if __name__ == "__main__":
    unittest.main()
