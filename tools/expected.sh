#!/bin/sh
# expected.sh: runs a case for the seeds 1..N and writes what it measures, with the spread over the seeds, to
# expected.toml beside the case. The tolerance is what one more run keeps to with 95 % when figures are normal:
# t(N-1, 0.975) sqrt(1 + 1/N) spread, and at least 1e-6 of the value.
# Usage: tools/expected.sh CASE.toml N [--output FILE] [--keep DIR] [options of `scree run`, e.g. --set key=value]
#   --keep DIR: leave the runs there (DIR/1, DIR/2, ...); SCREE=PROGRAM: which scree, default build/cpu/bin/scree
# SPDX-License-Identifier: Apache-2.0
set -eu
usage() {
  sed -n '5,6p' "$0" | cut -c3- >&2
  exit 2
}
[ $# -ge 2 ] || usage
root=$(cd "$(dirname "$0")/.." && pwd)
scree=${SCREE:-$root/build/cpu/bin/scree}
case_file=$1
seeds=$2
shift 2
case $seeds in '' | *[!0-9]*) usage ;; esac
if [ "$seeds" -lt 3 ]; then
  echo "error: N = $seeds: a spread needs at least 3 seeds" >&2
  exit 2
fi
output=$(dirname "$case_file")/expected.toml
keep=
while [ $# -ge 2 ]; do
  case $1 in
  --output) output=$2 ;;
  --keep) keep=$2 ;;
  *) break ;;
  esac
  shift 2
done

work=${keep:-$(mktemp -d)}
mkdir -p "$work"
clean() { [ -n "$keep" ] || rm -rf "$work"; }
trap clean EXIT
trap 'exit 130' INT TERM
seed=1
while [ "$seed" -le "$seeds" ]; do
  echo "seed $seed of $seeds" >&2
  "$scree" run "$case_file" --set "case.seed=$seed" --output "$work/$seed" --force --quiet "$@" >"$work/$seed.log" || {
    cat "$work/$seed.log" >&2
    echo "error: the run of seed $seed failed" >&2
    exit 1
  }
  "$scree" info "$work/$seed/results.h5" --figures >"$work/$seed.csv"
  seed=$((seed + 1))
done

# name,unit,of,value,...: a line a quantity, the same in every file. Figures that some seed lacks are left out.
seed=1
files=
while [ "$seed" -le "$seeds" ]; do
  files="$files $work/$seed.csv"
  seed=$((seed + 1))
done
# shellcheck disable=SC2086 # a list of files
awk -F, -v n="$seeds" -v case_file="$(basename "$case_file")" '
  BEGIN {
    split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228 2.201 2.179 2.160 2.145", t, " ")
    factor = (n - 1 <= 14 ? t[n - 1] : 2.1) * sqrt(1 + 1 / n)
  }
  FNR == 1 { next }
  !($1 in count) { order[++names] = $1; unit[$1] = $2; of[$1] = $3; count[$1] = 0 }
  $4 !~ /nan|inf/ { value[$1, ++count[$1]] = $4 }
  END {
    printf "# %s, seeds 1 to %d, by tools/expected.sh; check a run: scree info results.h5 --expected expected.toml\n", case_file, n
    for (i = 1; i <= names; ++i) {
      name = order[i]
      if (count[name] < n) { printf "# %s: undefined in %d of %d runs\n", name, n - count[name], n; continue }
      mean = square = 0
      for (k = 1; k <= n; ++k) mean += value[name, k] / n
      for (k = 1; k <= n; ++k) square += (value[name, k] - mean) ^ 2
      spread = sqrt(square / (n - 1))
      size = mean < 0 ? -mean : mean
      tolerance = factor * spread
      if (tolerance < 1e-6 * size) tolerance = 1e-6 * size
      printf "\n[[expected]]\nname = \"%s\"\nunit = \"%s\"\nof = \"%s\"\nvalue = %.6g\nspread = %.3g\ntolerance = %.3g\nseeds = %d\n", name, unit[name], of[name], mean, spread, tolerance, n
    }
  }' $files >"$work/expected.toml"
if ! grep -q '^\[\[expected\]\]' "$work/expected.toml"; then
  echo "error: $case_file measures nothing: it needs [[measure]] entries" >&2
  exit 2
fi
cp "$work/expected.toml" "$output"
[ -z "$keep" ] || rm "$work/expected.toml"
echo "$output"
