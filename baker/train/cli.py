"""The trainer's commands."""
import argparse
import dataclasses
import json
import os
import sys

from .data.dataset import SPLITS
from .files.safetensors import BadData


def _add_fields(parser, options, skip=()):
    """One option a dataclass field, its default shown."""
    for f in dataclasses.fields(options):
        if f.name in skip:
            continue
        kind = (
            (lambda text: tuple(int(c) if c.isdigit() else c for c in text.split(",") if c))
            if isinstance(f.default, tuple)
            else type(f.default)
        )
        kind = (lambda text: text not in ("0", "false", "no")) if isinstance(f.default, bool) else kind
        parser.add_argument(
            "--" + f.name.replace("_", "-"), type=kind, default=f.default, help=f"default {f.default}"
        )


def _from_fields(options, arguments):
    return options(
        **{
            f.name: getattr(arguments, f.name)
            for f in dataclasses.fields(options)
            if hasattr(arguments, f.name)
        }
    )


def _character(text):
    name, _, path = text.partition("=")
    if not (name and path):
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=PATH")
    return name, path


def _generate(a):
    from .data.generate import generate

    sheet = generate(a.bake, a.plan, a.out, dict(a.character), a.processes, splits=a.splits)
    print(
        f"{a.out}: {len(sheet['sequences'])} sequences of {len(sheet['bodies'])} bodies, "
        f"{sheet['seconds_simulated']:.0f} s simulated, {len(sheet['failed'])} failed"
    )


def _train(a):
    import torch
    from .learn.options import TrainOptions
    from .learn.train import train

    torch.set_num_threads(a.threads)
    options = _from_fields(TrainOptions, a)
    if options.device == "auto":
        options.device = "cuda" if torch.cuda.is_available() else "cpu"
    train(a.data, a.out, options)


def _train_rods(a):
    import torch
    from .rods.train import RodTrainOptions, train_rods

    torch.set_num_threads(a.threads)
    train_rods(a.data, a.out, _from_fields(RodTrainOptions, a))


def _export_rods(a):
    from .rods.export import export_examples, export_rods

    if (a.run is None) == (a.examples == 0):
        raise BadData("export-rods: give either --run or --examples")
    if a.run is None:
        export_examples(a.data, a.out, a.name, a.examples, a.seed)
    else:
        export_rods(a.run, a.data, a.out, a.name)


def _train_patches(a):
    import torch
    from .patches.train import PatchTrainOptions, train_patches

    torch.set_num_threads(a.threads)
    train_patches(a.data, a.out, _from_fields(PatchTrainOptions, a))


def _export_patches(a):
    from .patches.export import export_patches

    export_patches(a.run, a.data, a.out, a.name, a.page)


def _read_json(path, mend):
    try:
        with open(path) as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise BadData(f"{path}: {error}; {mend}") from None


def _named(pairs):
    """NAME=FOLDER and NAME=WEIGHTS.safetensors arguments as a dict, in order."""
    for text in pairs:
        if "=" not in text:
            raise BadData(f"--run {text}: give NAME=FOLDER or NAME=WEIGHTS.safetensors")
    return dict(text.split("=", 1) for text in pairs)


def _evaluate(a):
    import torch
    from .judge.evaluate import evaluate, table
    from .judge.page import write_evaluation

    torch.set_num_threads(a.threads)
    runs = _named(a.run)
    enduring = (next(iter(runs)), "modal_warped", *a.enduring)
    metrics, judged = evaluate(runs, a.data, a.bodies or None, enduring)
    write_evaluation(metrics, judged, runs, a.out, not a.no_page)
    for body in metrics["bodies"]:
        print(table(metrics, body))


def _ablate(a):
    from .judge.ablate import ablate

    _compare(ablate, a)


def _vanilla(a):
    from .judge.paper_forms import compare_forms

    _compare(compare_forms, a)


def _compare(how, a):
    import torch

    torch.set_num_threads(1)
    how(a.data, a.body, a.work, a.out, a.minutes, a.processes)


def _export(a):
    from .judge.export import export

    metrics = _read_json(os.path.join(a.page, "metrics.json"), "run `baker/train evaluate` again")
    export(a.run, a.data, metrics, a.out, a.name, a.model, a.body)


def _characters(a):
    from .judge.characters import characters

    for one in characters(a.work, os.path.join(a.assets, "evaluation", "characters"), a.assets, a.bake):
        print(f"{one.name}: {one.all.of_base('fine-tuned'):.2f} of the modal base's error, {'shipped' if one.pays() else 'not shipped'}")


def _best(a):
    """The run whose validation roll-outs were best."""

    def score(run):
        return _read_json(os.path.join(run, "curve.json"), "train again")["best"]

    print(min(a.runs, key=score))


def _add_comparison(p, minutes):
    """Options of a command that trains variants on one body and writes a table and a picture of their errors."""
    p.add_argument("data")
    p.add_argument("--body", required=True)
    of_one = f"of one core, a variant; default {minutes:g}"
    p.add_argument("--minutes", type=float, default=minutes, help=of_one)
    p.add_argument("--processes", type=int, default=2)
    p.add_argument("--work", required=True, help="folder of the runs; a second call goes on")
    p.add_argument("--out", required=True, help="folder of the evaluation page")


def _parser():
    parser = argparse.ArgumentParser(
        prog="baker/train", description="Trains tissue networks from ground truth."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def command(name, run, text):
        p = commands.add_parser(name, help=text, description=text)
        p.set_defaults(run_command=run)
        return p

    p = command("generate", _generate, "Simulates a data set with sinew-bake truth.")
    p.add_argument("--bake", required=True, help="path of sinew-bake")
    p.add_argument("--plan", required=True, help="plan, JSON; the body files lie next to it")
    p.add_argument("--out", required=True, help="folder of the data set; one that was cut goes on")
    p.add_argument("--processes", type=int, default=2)
    p.add_argument(
        "--character",
        type=_character,
        action="append",
        default=[],
        metavar="NAME=PATH",
        help="a further body, tested on: a skinned .glb; repeatable",
    )
    now = "simulate these now; default all"
    p.add_argument("--splits", nargs="+", default=SPLITS, choices=SPLITS, help=now)
    p = command("train", _train, "Trains one network.")
    p.add_argument("data", help="folder of the data set")
    p.add_argument("--out", required=True, help="folder of the run; a run that was cut goes on")
    p.add_argument("--threads", type=int, default=1)
    from .learn.options import TrainOptions

    _add_fields(p, TrainOptions)
    p = command("evaluate", _evaluate, "Judges runs on held-out motions and bodies: the evaluation page.")
    p.add_argument("data")
    named = "NAME=FOLDER of a run or NAME=WEIGHTS.safetensors; repeatable, the shipped one first"
    p.add_argument("--run", action="append", required=True, help=named)
    p.add_argument("--bodies", nargs="+", help="default: all with test sequences")
    p.add_argument("--enduring", nargs="*", default=[], help="further models for the longest roll-outs")
    p.add_argument("--threads", type=int, default=1)
    p.add_argument("--out", required=True, help="folder of the page")
    p.add_argument("--no-page", action="store_true", help="metrics.json and errors.csv alone")
    text = "Trains small variants of the recipe on one body and compares them."
    _add_comparison(command("ablate", _ablate, text), 4.0)
    text = "Trains the paper's vanilla ConvLSTMs on one body and compares them with Alt-ConvLSTM."
    _add_comparison(command("vanilla", _vanilla, text), 3.0)
    text = "Writes weights with their errors stated, and check vectors, of a judged run."
    p = command("export", _export, text)
    p.add_argument("data")
    p.add_argument("--run", required=True)
    p.add_argument("--page", required=True, help="folder of the evaluation page")
    p.add_argument("--model", required=True, help="the run's name on that page")
    p.add_argument("--body", required=True, help="body whose error is stated in the weights")
    p.add_argument("--out", required=True)
    p.add_argument("--name", required=True)
    p = command("train-rods", _train_rods, "Trains a network that corrects a rod's extrapolated start.")
    p.add_argument("data", help="folder of runs, of sinew-bake rod-data")
    p.add_argument("--out", required=True, help="folder of the run")
    p.add_argument("--threads", type=int, default=1)
    from .rods.train import RodTrainOptions

    _add_fields(p, RodTrainOptions)
    text = "Writes weights of a start with their errors and check vectors, or examples for k-NN."
    p = command("export-rods", _export_rods, text)
    p.add_argument("data")
    p.add_argument("--run", help="folder of train-rods")
    p.add_argument("--examples", type=int, default=0, help="how many, instead of a run")
    p.add_argument("--seed", type=int, default=0, help="of the examples")
    p.add_argument("--out", required=True)
    p.add_argument("--name", required=True)
    p = command("train-patches", _train_patches, "Trains an emulator of patches (DeepEmulator).")
    p.add_argument("data", help="folder of runs, of sinew-bake patch-data")
    p.add_argument("--out", required=True, help="folder of the run")
    p.add_argument("--threads", type=int, default=1)
    from .patches.train import PatchTrainOptions

    _add_fields(p, PatchTrainOptions)
    p = command("export-patches", _export_patches, "Judges an emulator on held-out bodies and writes its weights.")
    p.add_argument("data")
    p.add_argument("--run", required=True, help="folder of train-patches")
    p.add_argument("--page", required=True, help="folder of tables and plots")
    p.add_argument("--out", required=True)
    p.add_argument("--name", required=True)
    text = "Writes the page of characters with networks of their own, and ships those that pay."
    p = command("characters", _characters, text)
    p.add_argument("work", help="folder of sinew-train --keep's outputs")
    p.add_argument("--bake", required=True, help="path of sinew-bake")
    p.add_argument("--assets", required=True, help="folder with gallery and evaluation")
    p = command("best", _best, "Prints the run that validated best.")
    p.add_argument("runs", nargs="+")
    return parser


def main(arguments=None):
    """Exit codes: 0 good, 2 unusable input (one line says what, where, how to mend)."""
    a = _parser().parse_args(arguments)
    try:
        a.run_command(a)
    except BadData as error:
        print(f"baker/train: {error}", file=sys.stderr)
        return 2
    return 0
