#!/usr/bin/env bash
# Measures contacts: strands on a head, ropes against Bullet's soft bodies, and surfaces in Embree. Rewrites perf/reports/contacts.csv,
# ropes.csv and surfaces.csv and their tables in perf/README.md. About two minutes on one quiet core.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_contacts perf_ropes perf_surfaces
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
for bench in contacts ropes surfaces; do
  build/release/bin/perf_$bench >"$measured/$bench.csv"
done
"${PYTHON:-/usr/bin/python3}" perf/summarise.py perf/contacts.sh contacts="$measured/contacts.csv" ropes="$measured/ropes.csv" \
  surfaces="$measured/surfaces.csv"
