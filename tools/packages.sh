# packages.sh: what Scree is built from, as Debian 12 packages; sourced by quickstart.sh and test.sh.
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=sh disable=SC2034

engine_packages="build-essential cmake ninja-build ccache libhdf5-dev libtomlplusplus-dev libfmt-dev libcli11-dev libpng-dev zlib1g-dev libeigen3-dev libthrust-dev"
test_packages="libgtest-dev libbenchmark-dev clang-format-14 libcgal-dev libtorch-dev libopenblas0-pthread nlohmann-json3-dev libonnx-dev libprotobuf-dev python3-vtk9 python3-matplotlib"

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Abbrev}' "$1" 2>/dev/null)" = "ii " ]; }

# install_packages NAME...: installs what is missing; does nothing, and needs no network, when all is there.
install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    name_missing_programs
    return
  fi
  missing=""
  for package in "$@"; do is_installed "$package" || missing="$missing $package"; done
  [ -z "$missing" ] && return
  echo "installing:$missing"
  as_root=""
  if [ "$(id -u)" != 0 ]; then
    as_root=sudo
    if ! command -v sudo >/dev/null; then
      echo "error: neither root nor sudo; run as root: apt-get install$missing" >&2
      exit 1
    fi
  fi
  $as_root apt-get update -q
  # shellcheck disable=SC2086 # words are package names
  if ! $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing; then
    echo "error: apt-get could not install:$missing" >&2
    exit 1
  fi
}

# On other systems the user installs; CMake then names any library that is not found.
name_missing_programs() {
  echo "This is no Debian system. Needed: a C++20 compiler, CMake >= 3.25, Ninja, HDF5 (C), toml++ 3, fmt 9, CLI11 2, libpng, zlib, Eigen 3, Thrust"
  absent=""
  for program in cmake ninja c++; do command -v "$program" >/dev/null || absent="$absent $program"; done
  if [ -n "$absent" ]; then
    echo "error: missing programs:$absent" >&2
    exit 1
  fi
}
