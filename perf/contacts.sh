#!/usr/bin/env bash
# Measures contacts: what they cost strands on a head, ropes beside Bullet's own, and surfaces in Embree. Rewrites their tables in
# perf/README.md and perf/results/<processor>_{contacts,ropes,surfaces}.csv. About six minutes on one quiet core.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_contacts perf_ropes perf_surfaces
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
for bench in contacts ropes surfaces; do
  build/release/bin/perf_$bench >"$measured/$bench.csv"
  python3 perf/summarise_table.py $bench "$measured/$bench.csv"
done
