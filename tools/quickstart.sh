#!/bin/sh
# quickstart.sh: from a fresh Debian 12 machine to a picture: installs packages, builds the engine, runs
# cases/packing/mix.toml, draws the last frame. Repeated, it does only what is new.
# Usage: tools/quickstart.sh [--set key=value ...]   further options are those of `scree run`
# SPDX-License-Identifier: Apache-2.0
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tools/packages.sh"

# shellcheck disable=SC2086 # words are package names
install_packages $engine_packages
build="$root/build/quickstart"
mkdir -p "$build"
if ! cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSCREE_CUDA=OFF -DSCREE_TESTS=OFF \
  -DSCREE_MESH=OFF -DSCREE_TRAINING=OFF -DSCREE_BENCHMARKS=OFF >"$build/configure.log" 2>&1; then
  cat "$build/configure.log" >&2
  echo "error: configuring failed; the lines above name what is missing" >&2
  exit 1
fi
cmake --build "$build"

scree="$build/bin/scree"
output="$build/packing-mix.out"
"$scree" run "$root/cases/packing/mix.toml" --output "$output" --force "$@"
"$scree" render "$output/results.h5" -o "$output/packing-mix.png"

echo
echo "results   $output/results.h5"
echo "ParaView  $output/paraview/scene.pvd"
echo "picture   $output/packing-mix.png"
