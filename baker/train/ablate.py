"""What each part of the recipe is worth: small variants trained alike on one body, judged on its held-out
motions."""
import concurrent.futures
import json
import os
import subprocess
import sys

from . import dataset, plot
from .evaluate import Network, ratio
from .page import write_text
from .rollout import error_ratio, truth
from .safetensors import BadData

# name -> options of `baker/train train`
VARIANTS = {
    "as shipped": [],
    "no modal base": ["--without", "base,base_step,turn"],
    "displacement not fed back": ["--without", "displacement,velocity"],
    "not told what it feels": ["--without", "felt_step"],
    "no leak in hidden layers": ["--hidden-leak", "0"],
    "gradients over 5 ticks": ["--window", "5"],
    "channels 8, 8, 3": ["--channels", "8,8,3"],
    "channels 32, 32, 3": ["--channels", "32,32,3"],
}
TICKS = (10, 50, 200)


def _folder(work, name):
    return os.path.join(work, "".join(c if c.isalnum() else "_" for c in name))


def _train(data, body, work, name, minutes):
    run = _folder(work, name)
    os.makedirs(run, exist_ok=True)
    command = [sys.executable, os.path.dirname(os.path.abspath(__file__)), "train", data, "--out", run, "--bodies", body]
    with open(os.path.join(run, "log.txt"), "w") as log:
        done = subprocess.run([*command, "--minutes", f"{minutes:g}", *VARIANTS[name]], stdout=log, stderr=log)
    if done.returncode:
        raise BadData(f"{run}: training '{name}' failed; its log.txt says why")


def _judge(run, groups):
    network, row = Network(os.path.join(run, "weights.safetensors")), {}
    for g in groups:
        p, u = network.predict(g), truth(g)
        if g.ticks <= 600:
            row.update({str(k): round(error_ratio(p, u, k), 4) for k in TICKS})
        else:
            row[str(g.ticks)] = ratio(p, u)
    return {"parameters": network.parameters, **row}


def _draw(rows, path):
    figure, a = plot._pyplot().subplots(figsize=(8, 0.45 * len(rows) + 1))
    keys = [k for k in next(iter(rows.values())) if k != "parameters"]
    height = 0.8 / len(keys)
    for i, (k, colour) in enumerate(zip(keys, plot.COLOURS)):
        a.barh([y + i * height for y in range(len(rows))], [min(r[k], 2) for r in rows.values()], height, color=colour, label=f"{int(k):,} ticks")
    a.set_yticks([y + 0.3 for y in range(len(rows))], list(rows), fontsize=8)
    a.invert_yaxis()
    a.set_xlabel("error / error of skinning alone (bars end at 2)")
    a.legend(frameon=False, fontsize=8)
    plot._finish(figure, [a], path)


def ablate(data, body, work, out, minutes, processes):
    """Writes out/ablations.json, ablations.md and ablations.png."""
    with concurrent.futures.ThreadPoolExecutor(processes) as pool:
        list(pool.map(lambda name: _train(data, body, work, name, minutes), VARIANTS))
    groups = dataset.group(dataset.read_split(data, "test", body))
    groups += [g for g in dataset.group(dataset.read_split(data, "long", body)) if g.ticks <= 3600]
    rows = {name: _judge(_folder(work, name), groups) for name in VARIANTS}
    os.makedirs(out, exist_ok=True)
    with open(os.path.join(out, "ablations.json"), "w") as file:
        json.dump({"body": body, "minutes": minutes, "rows": rows}, file, indent=1)
        file.write("\n")
    _draw(rows, os.path.join(out, "ablations.png"))
    keys = list(next(iter(rows.values())))
    lines = [f"| {minutes:g} minutes of one core each, trained on {body} alone | " + " | ".join(keys) + " |"]
    lines.append("|---" * (len(keys) + 1) + "|")
    lines += [f"| {name} | " + " | ".join(str(row[k]) for k in keys) + " |" for name, row in rows.items()]
    with open(os.path.join(out, "ablations.md"), "w") as file:
        file.write("\n".join(lines) + "\n\n![ablations](ablations.png)\n")
    if os.path.exists(os.path.join(out, "metrics.json")):
        write_text(out)
