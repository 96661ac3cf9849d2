#!/usr/bin/env bash
# Installs what is missing, builds, runs every test. Arguments go to ctest: tests/run.sh -R world/
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh
preset=${SINEW_PRESET:-release}
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
exec ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" "$@"
