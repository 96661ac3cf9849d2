#!/usr/bin/env bash
# Installs the Debian packages Sinew is built, tested and shown with. Does nothing, in well under a second, when all are there.
# usage: install_packages.sh [samples|web|PRESET]; samples: without what only training and tests need; web: those of samples and a
# compiler for WebAssembly; aarch64: all, the cross compiler, an emulator and libraries of that architecture; clang, fuzz: all and that compiler
set -euo pipefail

packages=(
  g++ cmake ninja-build                                   # build
  libeigen3-dev libhwy-dev                                # runtime
  libtinygltf-dev nlohmann-json3-dev libcli11-dev libmeshoptimizer-dev libstb-dev libsuitesparse-dev # baker
  libbullet-dev                                           # runtime/adapters/bullet
  libembree-dev ffmpeg                                    # samples
  catch2 pkg-config tcc python3-cffi                      # tests
  python3-numpy python3-matplotlib libopenblas0-pthread   # plots
)
wasm=(clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32)
case "${1:-}" in
  samples) ;;
  web) packages+=("${wasm[@]}") ;;
  *) packages+=(python3-torch "${wasm[@]}" chromium) ;;  # training, and tests of the page
esac
case "${1:-}" in
  clang) packages+=(clang-14) ;;
  fuzz) packages+=(clang-14 libclang-rt-14-dev) ;;  # libFuzzer and its sanitizers
esac
foreign=
if [ "${1:-}" = aarch64 ]; then
  packages+=(g++-aarch64-linux-gnu qemu-user libhwy-dev:arm64)
  foreign=arm64
fi

# Of whatever origin: some machines have newer ones than Debian's.
command -v npm >/dev/null || packages+=(nodejs npm)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install_packages: need root or sudo to install: ${missing[*]}" >&2; exit 2; }
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
[ -z "$foreign" ] || "${as_root[@]}" dpkg --add-architecture "$foreign"
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive sh -c \
  'apt-get update -qq && apt-get install -y -qq --no-install-recommends "$@"' install "${missing[@]}" >"$log" 2>&1 || {
  tail -n 20 "$log" >&2
  echo "install_packages: apt-get could not install: ${missing[*]}" >&2
  exit 2
}
