#!/bin/sh
# bench_compare.sh: what a benchmark's times are at commit B, in times of what they are at commit A, in interleaved rounds.
# SPDX-License-Identifier: Apache-2.0
#
# usage: tools/bench_compare.sh A B [--rounds N] [--limit R] [--jobs N] [-- PROGRAM OPTIONS...]
#
# A, B: commits, built in temporary worktrees (with ccache where it is), or folders that hold the programs already.
# PROGRAM (default: a short bench_step) is one of the benchmarks that write JSON. Exit code 1: a median ratio is above R.
set -eu
usage() { sed -n 's/^# \{0,1\}//; 4,8p' "$0"; exit 2; }
[ $# -ge 2 ] || usage
a=$1 b=$2; shift 2
rounds=5 limit=0 jobs=2
while [ $# -gt 0 ]; do
  case $1 in
    --rounds) rounds=$2; shift 2 ;;
    --limit) limit=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --) shift; break ;;
    *) usage ;;
  esac
done
[ $# -gt 0 ] || set -- bench_step --grains 30 --nodes 400 --steps 200 --rounds 1 --threads 1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
clean() {
  for side in a b; do
    [ ! -d "$work/$side" ] || git -C "$here" worktree remove --force "$work/$side"
  done
  rm -rf "$work"
}
trap clean EXIT
trap 'exit 130' INT TERM

# programs SIDE COMMIT_OR_FOLDER PROGRAM: prints the folder with the program, which is built where it must be.
programs() {
  if [ -d "$2" ]; then (cd "$2" && pwd); return; fi
  git -C "$here" worktree add --quiet --detach "$work/$1" "$2" >&2
  export CCACHE_BASEDIR="$work/$1" CCACHE_NOHASHDIR=1
  cmake -S "$work/$1" -B "$work/$1/build/cpu" -G Ninja -DCMAKE_BUILD_TYPE=Release > "$work/$1.log"
  cmake --build "$work/$1/build/cpu" --target "$3" -j "$jobs" >> "$work/$1.log" || { tail -30 "$work/$1.log" >&2; exit 2; }
  echo "$work/$1/build/cpu/bin"
}
first=$(programs a "$a" "$1")
second=$(programs b "$b" "$1")
python=/usr/bin/python3; [ -x $python ] || python=python3
$python -B "$here/bench_ratios.py" --rounds "$rounds" --limit "$limit" "$first" "$second" -- "$@"
