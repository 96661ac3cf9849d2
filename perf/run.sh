#!/usr/bin/env bash
# Measures the kernels and rewrites perf/results/<processor>.csv and the tables in perf/README.md. About two minutes.
# SINEW_REFERENCE=path/to/alt_conv_lstm.py times the PyTorch network as well; SINEW_PYTHON is a Python that has PyTorch.
set -euo pipefail
cd "$(dirname "$0")/.."

command -v dpkg-query >/dev/null && dpkg-query -W libbenchmark-dev >/dev/null 2>&1 || {
  echo "perf/run.sh: Google Benchmark is missing: apt-get install libbenchmark-dev" >&2
  exit 2
}
cmake --preset release -DSINEW_BUILD_PERF=ON | grep "^-- perf:" || true
cmake --build --preset release --target perf_kernels
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
build/release/bin/perf_kernels --benchmark_repetitions=15 --benchmark_enable_random_interleaving=true \
  --benchmark_min_time=0.2 --benchmark_format=json >"$measured/kernels.json" 2>/dev/null
if [ -n "${SINEW_REFERENCE:-}" ]; then
  OMP_NUM_THREADS=1 "${SINEW_PYTHON:-python3}" perf/peers/alt_conv_lstm_torch.py "$SINEW_REFERENCE" >"$measured/peers.json"
fi
python3 perf/summarise.py "$measured"/*.json
