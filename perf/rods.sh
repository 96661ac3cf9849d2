#!/usr/bin/env bash
# Measures rods: their speed, and each solver's time to a residual. Rewrites perf/reports/rods.csv, rods_trade.csv and rods.png and their
# tables in perf/README.md and perf/trade/README.md. About seven minutes on one quiet core; a stopped run resumes from
# build/release/rods_trade.csv. --again starts over, --quick only shows that everything runs.
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
"${PYTHON:-/usr/bin/python3}" perf/summarise.py perf/rods.sh rods=build/release/rods.csv rods_trade="$measured"
