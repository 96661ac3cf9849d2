#!/usr/bin/env bash
# Measures the kernels and one character's growth. Rewrites perf/reports/kernels.csv, scale.csv and scale.png and their tables in
# perf/README.md. About three minutes.
# SINEW_REFERENCE=path/to/alt_conv_lstm.py times the PyTorch network as well; SINEW_PYTHON is a Python that has PyTorch.
set -euo pipefail
cd "$(dirname "$0")/.."

command -v dpkg-query >/dev/null && dpkg-query -W libbenchmark-dev >/dev/null 2>&1 || {
  echo "perf/run.sh: Google Benchmark is missing: apt-get install libbenchmark-dev" >&2
  exit 2
}
cmake --preset release | grep "^-- perf:" || true
cmake --build --preset release --target perf_kernels perf_scale sinew-bake
measured=$(mktemp -d)
trap 'rm -rf "$measured"' EXIT
python=${PYTHON:-/usr/bin/python3}
# On processors with AMX, oneDNN multiplies bytes in tiles and is four times slower than with VNNI: the peer is its faster path.
export ONEDNN_MAX_CPU_ISA=${ONEDNN_MAX_CPU_ISA:-AVX512_CORE_VNNI}
build/release/bin/perf_kernels --benchmark_repetitions=15 --benchmark_enable_random_interleaving=true \
  --benchmark_min_time=0.2 --benchmark_format=json >"$measured/kernels.json" 2>/dev/null
if [ -n "${SINEW_REFERENCE:-}" ]; then
  OMP_NUM_THREADS=1 "${SINEW_PYTHON:-python3}" perf/peers/alt_conv_lstm_torch.py "$SINEW_REFERENCE" >"$measured/peers.json"
fi
"$python" perf/benchmark_rows.py "$measured"/*.json >"$measured/kernels.csv"

# One character at several resolutions.
for vertices in 200 500 2000 7000 20000 50000; do
  build/release/bin/sinew-bake creature assets/creature/creature.json --vertices $vertices -o "$measured/$vertices.glb"
  build/release/bin/sinew-bake character "$measured/$vertices.glb" --recipe assets/creature/tissue.json \
    --tissue assets/weights/creature.safetensors --quick -o "$measured/$vertices.sinew" >/dev/null
done
build/release/bin/perf_scale "$measured"/{200,500,2000,7000,20000,50000}.sinew >"$measured/scale.csv"
"$python" perf/summarise.py perf/run.sh kernels="$measured/kernels.csv" scale="$measured/scale.csv"
