#!/usr/bin/env bash
# Measures rods: perf_rods and the trade of time against exactness. Rewrites perf/results/<processor>_rods*.csv, perf/trade/rods.png and
# the tables of rods in perf/README.md and perf/trade/README.md. About ten minutes on one quiet core; a run that was stopped goes on
# where it was, by what it has left in build/release/rods_trade.csv. --again begins anew, --quick only shows that everything runs.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_rods perf_trade_rods
measured=build/release/rods_trade.csv
if [ "${1:-}" = --quick ]; then
  quick=$(mktemp -d)
  trap 'rm -rf "$quick"' EXIT
  build/release/bin/perf_trade_rods "$quick/trade.csv" --quick
  exit
fi
starts=(--examples assets/weights/coping_examples.safetensors --network "${SINEW_ROD_WEIGHTS:-assets/weights/coping_8.safetensors}")
[ "${1:-}" != --again ] || rm -f "$measured"
build/release/bin/perf_rods >build/release/rods.csv
build/release/bin/perf_trade_rods "$measured" "${starts[@]}"
python=python3
"$python" -c 'import matplotlib' 2>/dev/null || python=/usr/bin/python3
"$python" perf/summarise_rods.py build/release/rods.csv
"$python" perf/summarise_trade.py "$measured"
