"""Times the reference Alt-ConvLSTM in PyTorch on the graph and widths of the bench alt_conv_lstm_paper.

usage: alt_conv_lstm_torch.py REFERENCE.py [REPETITIONS]
REFERENCE.py defines AltConvLSTM, with step(P, state, x_now, x_prev, offset), and normalized_adjacency.
Prints what Google Benchmark would: JSON with one entry a repetition, microseconds of thread CPU time on one thread.
"""
import importlib.util
import json
import pathlib
import sys
import time

import torch

COLUMNS, ROWS = 106, 65  # of the torus in perf/kernels/bench_data.hpp
CHANNELS, INPUTS = (32, 64, 128, 64, 32, 3), 9


def load(path):
    if not pathlib.Path(path).is_file():
        sys.exit(f"alt_conv_lstm_torch.py: {path} is not a file; name the reference network's Python file")
    spec = importlib.util.spec_from_file_location("reference", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def torus_edges():
    steps = ((1, 0), (0, 1), (1, 1))
    return [(y * COLUMNS + x, (y + v) % ROWS * COLUMNS + (x + u) % COLUMNS)
            for y in range(ROWS) for x in range(COLUMNS) for u, v in steps]


def product_mflop():
    widths = (INPUTS,) + CHANNELS
    return 2e-6 * COLUMNS * ROWS * sum(4 * a * b + 7 * b * b for a, b in zip(widths, widths[1:]))


def main(reference, repetitions=9):
    torch.manual_seed(1)
    torch.set_num_threads(1)
    module, nodes, runs = load(reference), COLUMNS * ROWS, []
    graph, network = module.normalized_adjacency(nodes, torus_edges()), module.AltConvLSTM(CHANNELS, INPUTS)
    x, offset = torch.rand(nodes, 3), torch.zeros(nodes, 3)
    with torch.no_grad():
        state = network.initial_state(nodes, x)
        for _ in range(3 + int(repetitions)):
            start = time.thread_time()
            network.step(graph, state, x, x, offset)
            runs.append((time.thread_time() - start) * 1e6)
    entries = [{"name": "pytorch_paper", "run_type": "iteration", "cpu_time": run, "label": f"PyTorch {torch.__version__}",
                "mega_operations": product_mflop()} for run in runs[3:]]
    print(json.dumps({"benchmarks": entries}))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
