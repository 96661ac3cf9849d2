#!/usr/bin/env bash
# Measures the kernels and rewrites perf/results/<processor>.csv and the table in perf/README.md. About a minute.
set -euo pipefail
cd "$(dirname "$0")/.."

command -v dpkg-query >/dev/null && dpkg-query -W libbenchmark-dev >/dev/null 2>&1 || {
  echo "perf/run.sh: Google Benchmark is missing: apt-get install libbenchmark-dev" >&2
  exit 2
}
cmake --preset release -DSINEW_BUILD_PERF=ON >/dev/null
cmake --build --preset release --target perf_kernels
measured=$(mktemp)
trap 'rm -f "$measured"' EXIT
build/release/bin/perf_kernels --benchmark_repetitions=9 --benchmark_format=json >"$measured" 2>/dev/null
python3 perf/summarise.py "$measured"
