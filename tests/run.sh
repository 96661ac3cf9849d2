#!/usr/bin/env bash
# Installs what is missing, builds, runs every test; then those that cross-build for 64-bit Arm, when the tools for it are there.
# Arguments go to ctest, and leave Arm out: tests/run.sh -R world/
set -euo pipefail
cd "$(dirname "$0")/.."

precompile=ON
[ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] || precompile=OFF

run_preset() {
  scripts/install_packages.sh "$1"
  cmake --preset "$1" -DSINEW_PRECOMPILE="$precompile" >/dev/null
  cmake --build --preset "$1"
  ctest --test-dir "build/$1" --output-on-failure -j "$(nproc)" "${@:2}"
}

has_arm_tools() {
  command -v aarch64-linux-gnu-g++ && command -v qemu-aarch64 && dpkg-query -W libhwy-dev:arm64
} >/dev/null 2>&1

run_preset "${SINEW_PRESET:-release}" "$@"
if [ -n "${SINEW_PRESET:-}" ] || [ $# -gt 0 ]; then
  exit
elif has_arm_tools; then
  # Emulated, ten thousand steps, thousands of rods and damage all over a file take minutes; each kernel has its other tests.
  run_preset aarch64 -E 'ten_thousand_steps|hair_that_slides|of_a_thousand_rods|two_thousand_segments|where_its_iteration_starts|hostile_words|random_damage'
else
  echo "The tests on 64-bit Arm were left out: the tools are not installed; scripts/install_packages.sh aarch64"
fi
