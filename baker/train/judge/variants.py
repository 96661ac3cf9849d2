"""Variants of the recipe, trained on one body in parallel, and the files that compare them."""
import concurrent.futures
import os
import subprocess
import sys

from ..data import dataset
from ..files.safetensors import BadData
from ..files.write_file import write_json
from .evaluate import ENDURANCE_TICKS, Network
from .page import write_csv, write_page_text


def _folder(work, name):
    return os.path.join(work, "".join(c if c.isascii() and c.isalnum() else "_" for c in name))


def _train(data, body, run, options, minutes):
    os.makedirs(run, exist_ok=True)
    trainer = [sys.executable, os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "train"]
    command = [*trainer, data, "--out", run, "--bodies", body, "--minutes", f"{minutes:g}", *options]
    with open(os.path.join(run, "log.txt"), "w") as log:
        done = subprocess.run(command, stdout=log, stderr=log)
    if done.returncode:
        raise BadData(f"{run}: training failed; its log.txt says why")


def train_variants(variants, data, body, work, minutes, processes):
    """name -> trained Network. variants: name -> options of `baker/train train`."""
    train = lambda name: _train(data, body, _folder(work, name), variants[name], minutes)
    with concurrent.futures.ThreadPoolExecutor(processes) as pool:
        list(pool.map(train, variants))
    return {name: Network(_folder(work, name)) for name in variants}


def judged_on(data, body):
    """Groups of a body's held-out motions, of up to a minute; the short ones first."""
    sequences = dataset.read_split(data, "test", body)
    if any(b == body for b, _ in dataset.list_split(data, "long")):
        sequences += dataset.read_split(data, "long", body)
    return dataset.group([(b, t) for b, t in sequences if len(t.drive) <= ENDURANCE_TICKS + 1])


def write_comparison(out, name, figures, head, rows):
    """out/name.json and out/name.csv; the evaluation page in out, where there is one, is written with a link to them."""
    os.makedirs(out, exist_ok=True)
    write_json(os.path.join(out, f"{name}.json"), figures)
    write_csv(os.path.join(out, f"{name}.csv"), head, rows)
    if all(os.path.exists(os.path.join(out, page)) for page in ("metrics.json", "README.md")):
        write_page_text(out)
