#!/usr/bin/env bash
# Measures the web sample: size, time to first motion, WebAssembly against native code, a crowd under a budget. Prints the figures and
# renders the pictures of samples/web/README.md. About four minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh release
cmake --preset release >/dev/null
cmake --build --preset release --target sinew-bake native_steps >/dev/null
folder=$PWD/build/web_perf
tests/samples/web/put_together.sh build/release/bin/sinew-bake build/web "$folder" >/dev/null
node perf/web/measure.mjs "$folder" build/release/bin/native_steps
node perf/web/pictures.mjs "$folder" assets/pictures
