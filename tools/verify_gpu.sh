#!/bin/sh
# verify_gpu.sh: everything that has to be shown on a GPU, in two parts of a few minutes each.
#   verify_gpu.sh build   configure and build engine, kernel tests and bench_device for this machine's GPU in build/gpu
#   verify_gpu.sh run     kernel tests, compute-sanitizer, a run and a picture on the GPU against the CPU, bench_device;
#                         a table of what passed, exit status 1 where something did not
# A folder `offline` (tools/offline_bundle.sh) beside the sources is used when it is there. OUT=DIR: where logs, JSON and
# the table go (default build/gpu/verify). ARCH=90: compute capability, asked of nvidia-smi when not given.
# SPDX-License-Identifier: Apache-2.0
set -u
root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build/gpu
out=${OUT:-$build/verify}
export OMP_WAIT_POLICY=passive

build_all() {
  nvcc=$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null) || {
    echo "error: no nvcc on the PATH" >&2
    return 3
  }
  arch=${ARCH:-$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null | head -n 1 | tr -d .)}
  set -- -DCMAKE_BUILD_TYPE=Release -DSCREE_CUDA=ON -DCMAKE_CUDA_COMPILER="$nvcc" -DSCREE_CUDA_ARCHITECTURES="${arch:-90}" \
    -DSCREE_MESH=OFF -DSCREE_TRAINING=OFF -DSCREE_EXCHANGE=OFF -DSCREE_BENCHMARKS=OFF
  if [ -d "$root/offline" ]; then
    libraries=$root/offline/lib/x86_64-linux-gnu
    set -- "$@" -DCMAKE_PREFIX_PATH="$root/offline" -DCMAKE_LIBRARY_PATH="$libraries" -DHDF5_ROOT="$root/offline" \
      -DCMAKE_BUILD_RPATH="$libraries" -DCMAKE_EXE_LINKER_FLAGS="-Wl,-rpath-link,$libraries"
  fi
  generator=
  command -v ninja >/dev/null && generator="-G Ninja"
  # shellcheck disable=SC2086 # two words or none
  cmake -S "$root" -B "$build" $generator "$@" &&
    cmake --build "$build" --parallel --target scree bench_device network_device_test core_hybrid_test core_render_test kernels_test sdf_batch_test
}

passed=0
failed=0
# check NAME COMMAND...: a line of the table; the output goes to a log of that name.
check() {
  name=$1
  shift
  start=$(date +%s)
  if "$@" >"$out/$name.log" 2>&1; then verdict=passed passed=$((passed + 1)); else verdict=FAILED failed=$((failed + 1)); fi
  printf '%-34s %s  %d s\n' "$name" "$verdict" $(($(date +%s) - start)) | tee -a "$out/table.txt"
  [ "$verdict" = passed ] || tail -n 20 "$out/$name.log"
}
# ran_on_gpu PROGRAM [OPTIONS]: a test program of which no CUDA instance may have been skipped.
ran_on_gpu() { "$@" >"$out/last.log" 2>&1; status=$?; cat "$out/last.log"; [ $status -eq 0 ] && ! grep -q '/cuda.*SKIPPED\|SKIPPED.*/cuda' "$out/last.log"; }
# same_run: a short packing on the CPU and on the GPU ends at the same poses, to the bit.
same_run() {
  for device in cpu cuda; do
    "$build/bin/scree" run "$root/cases/packing/mix.toml" --device $device --output "$out/$device" --force --quiet \
      --set time.end=0.35 --set output.every=0.05 --set output.paraview=false --set grains.mix.nodes=1000 || return 1
    "$build/bin/scree" export "$out/$device/results.h5" --stl --triangles 80 -o "$out/$device.stl" --force || return 1
  done
  cmp "$out/cpu.stl" "$out/cuda.stl"
}

# same_picture: that packing as a picture of 1280 x 960, drawn by both, is the same to the byte; how long each took.
same_picture() {
  for device in cpu cuda; do
    began=$(date +%s%N)
    "$build/bin/scree" render "$out/cpu/results.h5" -o "$out/$device.png" --ids "$out/$device-ids.png" --device $device || return 1
    eval "$device=$((($(date +%s%N) - began) / 1000000))"
  done
  echo "picture 1280 x 960: $cpu ms on the CPU, $cuda ms with networks on the GPU"
  cmp "$out/cpu.png" "$out/cuda.png" && cmp "$out/cpu-ids.png" "$out/cuda-ids.png"
}

run_all() {
  mkdir -p "$out"
  : >"$out/table.txt"
  { nvidia-smi --query-gpu=name,driver_version,memory.total,clocks.max.sm --format=csv,noheader 2>/dev/null || echo "no nvidia-smi"; } | tee -a "$out/table.txt"
  tests=$build/tests
  check network_device_test ran_on_gpu "$tests/network_device_test"
  check core_hybrid_test ran_on_gpu "$tests/core_hybrid_test"
  check core_render_test ran_on_gpu "$tests/core_render_test"
  grep -h 'pixels differ.*cuda' "$out/core_render_test.log" | tee -a "$out/table.txt"
  check kernels_test "$tests/kernels_test"
  check bench_device "$build/bin/bench_device" --output "$out/bench_device.json"
  sed -n '/Gqueries/,$p' "$out/bench_device.log" | tee -a "$out/table.txt"
  sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda/bin/compute-sanitizer 2>/dev/null)
  if [ -n "$sanitizer" ]; then
    for tool in memcheck racecheck; do
      check "$tool" "$sanitizer" --tool $tool --error-exitcode 9 "$tests/network_device_test" --gtest_filter='*ManyNetworks*/cuda:*Wanted*/cuda:*Walks*/cuda:*BitsOfAPoint*/cuda'
    done
  else
    echo "compute-sanitizer: not here" | tee -a "$out/table.txt"
  fi
  check packing_cpu_equals_gpu same_run
  grep -h 'particle-steps' "$out/cpu/run.log" "$out/cuda/run.log" | tee -a "$out/table.txt"
  check picture_cpu_equals_gpu same_picture
  grep -h '^picture 1280' "$out/picture_cpu_equals_gpu.log" | tee -a "$out/table.txt"
  echo "$passed passed, $failed failed" | tee -a "$out/table.txt"
  [ "$failed" -eq 0 ]
}

case ${1:-} in
build) build_all ;;
run) run_all ;;
*)
  sed -n '3,5p' "$0" | cut -c3- >&2
  exit 2
  ;;
esac
