#!/usr/bin/env bash
# Installs what is missing, builds the engine for browsers, bakes the creature, puts the page together in out/web and serves it.
# usage: run.sh [--folder]   --folder: without serving; out/web then works from any file server
set -euo pipefail
cd "$(dirname "$0")/../.."

out=out/web
scripts/install_packages.sh web
cmake --preset release >/dev/null
cmake --build --preset release --target sinew-bake | { grep -v '^ninja: no work' || true; }
samples/bake_creature.sh build/release/bin/sinew-bake out tissue_crowd tissue_rods tissue_touch
samples/web/put_together.sh build/web "$out" out
[ "${1:-}" = --folder ] || exec node samples/web/serve.mjs "$out" 8080
