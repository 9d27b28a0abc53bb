#!/bin/sh
# run.sh: runs every fuzzer for so many seconds over its corpus. Usage: run.sh SECONDS [BUILD_FOLDER] [NAME...]
# The committed corpus is only read: new inputs stay in BUILD_FOLDER/corpus, what was found in BUILD_FOLDER/found.
# SPDX-License-Identifier: Apache-2.0
set -u
here=$(cd "$(dirname "$0")" && pwd)
seconds=${1:?usage: run.sh SECONDS [BUILD_FOLDER] [NAME...]}
build=$(cd "${2:-$here/../../build/fuzz}" && pwd) || exit 1
shift; [ $# -gt 0 ] && shift
if [ $# -eq 0 ]; then
  for program in "$build"/fuzz/fuzz_*; do set -- "$@" "${program##*/fuzz_}"; done
fi
mkdir -p "$build/found"
cd "$build/found" || exit 1 # an empty place: no file that an input names is there
# libhdf5 keeps what belongs to files that it could not close.
export LSAN_OPTIONS="${LSAN_OPTIONS:-suppressions=$here/../leaks.supp}"
status=0
for name in "$@"; do
  mkdir -p "$build/corpus/$name"
  dictionary=""
  [ -f "$here/$name.dict" ] && dictionary="-dict=$here/$name.dict"
  log="$build/found/$name.log"
  # shellcheck disable=SC2086 # no word where there is no dictionary
  if OMP_NUM_THREADS=1 "$build/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
    -artifact_prefix="$build/found/$name-" $dictionary "$build/corpus/$name" "$here/corpus/$name" >"$log" 2>&1; then
    echo "fuzz_$name: $(tail -n 1 "$log")"
  else
    echo "fuzz_$name: FAILED"
    tail -n 60 "$log"
    status=1
  fi
done
exit $status
