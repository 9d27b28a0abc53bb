#!/bin/sh
# offline_bundle.sh: collects what engine, tests and benchmarks are built from into one relocatable folder, for a GPU
# machine without internet and without packages: headers, CMake files and the closure of shared libraries, each of
# which finds its neighbours. No CGAL, no LibTorch. Build against it with -DCMAKE_PREFIX_PATH=FOLDER, as
# tools/verify_gpu.sh does. To be run on Debian 12; the other machine needs a glibc and libstdc++ as new as these.
# Usage: tools/offline_bundle.sh [FOLDER]      default: offline, beside the sources
# SPDX-License-Identifier: Apache-2.0
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tools/packages.sh"
folder=${1:-$root/offline}
arch=x86_64-linux-gnu
# shellcheck disable=SC2086 # words are package names
install_packages $engine_packages libgtest-dev libbenchmark-dev patchelf
case $folder in /*) ;; *) folder=$PWD/$folder ;; esac
if [ -e "$folder" ] && [ ! -e "$folder/bundle.txt" ]; then
  echo "error: $folder exists and is no bundle" >&2
  exit 4
fi
rm -rf "$folder"
mkdir -p "$folder/include" "$folder/lib/$arch"

# Headers and CMake files where the packages have them, so that their relative paths hold. Thrust comes with CUDA.
for package in libhdf5-dev libtomlplusplus-dev libfmt-dev libcli11-dev libpng-dev zlib1g-dev libeigen3-dev libgtest-dev libbenchmark-dev; do
  dpkg -L "$package" | grep -E "^/usr/(include/|lib/cmake/|lib/$arch/cmake/|share/cmake/|share/eigen3/|lib/$arch/lib(gtest|gtest_main|benchmark|benchmark_main)\.(a|so))" |
    while read -r file; do
      if [ -d "$file" ] && [ ! -L "$file" ]; then continue; fi
      target=$folder/${file#/usr/}
      mkdir -p "$(dirname "$target")"
      cp -P "$file" "$target"
    done
done
cp -RL /usr/include/hdf5/serial/. "$folder/include"
rm -rf "$folder/include/hdf5" "$folder/include/eigen3/unsupported"

# Shared libraries and all they need, but what every C++ machine has.
closure=$(mktemp)
trap 'rm -f "$closure"' EXIT
libraries="/usr/lib/$arch/libhdf5_serial.so /usr/lib/$arch/libfmt.so /usr/lib/$arch/libpng16.so /usr/lib/$arch/libz.so /usr/lib/$arch/libtomlplusplus.so /usr/lib/$arch/libbenchmark.so"
for library in $libraries; do
  [ -e "$library" ] || continue
  readlink -f "$library"
  ldd "$library" | awk '$2 == "=>" && $3 ~ /^\// { print $3 }'
done | grep -vE '/(libc|libm|libdl|librt|libpthread|libgcc_s|libstdc\+\+|libresolv)\.so' | while read -r f; do readlink -f "$f"; done | sort -u >"$closure"
while read -r library; do
  name=$(basename "$library")
  cp "$library" "$folder/lib/$arch/$name"
  patchelf --set-rpath '$ORIGIN' "$folder/lib/$arch/$name"
  soname=$(patchelf --print-soname "$folder/lib/$arch/$name")
  [ "$soname" = "$name" ] || ln -sf "$name" "$folder/lib/$arch/$soname"
done <"$closure"
# The names that a linker looks for.
for name in fmt png16 z tomlplusplus benchmark; do
  found=$(cd "$folder/lib/$arch" && ls "lib$name".so.* 2>/dev/null | head -n 1)
  [ -z "$found" ] || ln -sf "$found" "$folder/lib/$arch/lib$name.so"
done
ln -sf libpng16.so "$folder/lib/$arch/libpng.so"
ln -sf "$(cd "$folder/lib/$arch" && ls libhdf5_serial.so.* | head -n 1)" "$folder/lib/$arch/libhdf5.so"
# FindHDF5 looks in HDF5_ROOT/lib alone.
ln -sf "$arch/libhdf5.so" "$folder/lib/libhdf5.so"

{
  echo "Scree's offline bundle, from Debian $(cat /etc/debian_version)"
  # shellcheck disable=SC2086
  dpkg-query -W -f '${Package} ${Version}\n' $engine_packages libgtest-dev libbenchmark-dev
} >"$folder/bundle.txt"
echo "$folder: $(du -sm "$folder" | cut -f1) MiB"
