#!/usr/bin/env bash
# Installs what is missing, builds, runs every test; then those that cross-build for 64-bit Arm, when the tools for it are there.
# --fast: only the fast ones, in at most three minutes after the build. Other arguments go to ctest: tests/run.sh -R world/
# Both leave Arm out.
set -euo pipefail
cd "$(dirname "$0")/.."

run_preset() {
  scripts/install_packages.sh "$1"
  cmake --preset "$1" >/dev/null
  cmake --build --preset "$1"
  ctest --test-dir "build/$1" --output-on-failure -j "$(nproc)" "${@:2}"
}

has_arm_tools() {
  command -v aarch64-linux-gnu-g++ && command -v qemu-aarch64 && dpkg-query -W libhwy-dev:arm64
} >/dev/null 2>&1

[ "${1:-}" != --fast ] || set -- -L fast "${@:2}"
run_preset "${SINEW_PRESET:-release}" "$@"
if [ -n "${SINEW_PRESET:-}" ] || [ $# -gt 0 ]; then
  exit
elif [ "$SECONDS" -gt 850 ]; then
  # All is to end within half an hour; building and emulating take up to a quarter of one.
  echo "The tests on 64-bit Arm were left out: $SECONDS s have passed; SINEW_PRESET=aarch64 tests/run.sh runs them alone"
elif has_arm_tools; then
  # Emulated, an hour, ten thousand steps, thousands of rods, convergence over every stiffness, whole roll-outs of large networks and damage all
  # over a file take minutes. Each kernel has its other tests, rods' recorded bits are those of x86, and the roll-outs are begun.
  long_emulated=(an_hour_at_the_limit ten_thousand_steps hair_that_slides hair_that_ends of_a_thousand_rods of_ten_thousand two_thousand_segments where_its_iteration_starts
    rods_that_bend_far_more_stiffly rods_converge_at_every_stiffness soft_rods_keep_their_length reproduces_the_golden_roll_outs
    hostile_words random_damage)
  run_preset aarch64 -E "$(IFS='|'; echo "${long_emulated[*]}")"
else
  echo "The tests on 64-bit Arm were left out: the tools are not installed; scripts/install_packages.sh aarch64"
fi
