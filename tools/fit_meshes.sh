#!/usr/bin/env bash
# fit_meshes.sh: meshes through import, fit and inspect: a network with its certificate for each, and one table of all.
# Usage: tools/fit_meshes.sh OUT MESH... [-- options of `scree-train fit`, e.g. --seconds 60 --threads 1]
#   OUT/NAME.stl: the mesh checked and repaired; NAME.h5: the network; NAME.log: what the three said; table.csv: a line a
#   mesh (d, degrees, CPU seconds of the fit). BIN=FOLDER: where the programs are, default build/cpu/bin. A mesh that
#   fails does not stop the others; exit code 1 then.
# SPDX-License-Identifier: Apache-2.0
set -uo pipefail
usage() {
  sed -n '3p' "$0" | cut -c3- >&2
  exit 2
}
root=$(cd "$(dirname "$0")/.." && pwd)
bin=${BIN:-$root/build/cpu/bin}
[ $# -ge 2 ] || usage
out=$1
shift
meshes=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  meshes+=("$1")
  shift
done
[ ${#meshes[@]} -gt 0 ] || usage
[ $# -eq 0 ] || shift
mkdir -p "$out" || exit 4
echo "mesh,cpu_s,mae,p99,max,band_mae,normal_p50,normal_p95,flat_p95,flat_percent,interpolated_p95,\
interpolated_flat_p95,mesh_p95,mesh_flat_p95,gradient_p5,gradient_p95,falling,parts,euler,gap,hausdorff,volume,\
inertia" >"$out/table.csv" || exit 4

# The figures of one log, in the order of the table's head.
figures() {
  awk -v name="$1" -v cpu="$2" '
    /^measured now from phi/ { part = "phi" }
    /^measured now against the mesh/ { part = "mesh" }
    $1 == name && part == "phi" { gradient = $3 "," $4; rest = $7 "," $8 "," $9 "," $10 }
    $1 == name && part == "mesh" {
      errors = $2 "," $3 "," $4 "," $5; normals = $8 "," $9 "," $10 "," $11; other = $12 "," $13 "," $14
    }
    /^phi to normals interpolated/ { smooth = $(NF - 1) "," $NF }
    /^the triangles to the interpolated/ { own = $(NF - 1) "," $NF }
    END { print name "," cpu "," errors "," normals "," smooth "," own "," gradient "," rest "," other }'
}

# Whitespace would break the table apart, slashes the names of shapes.
failed=0
for mesh in "${meshes[@]}"; do
  name=$(basename "${mesh%.*}" | tr -c 'A-Za-z0-9._\n-' _)
  log=$out/$name.log
  TIMEFORMAT=%U
  cpu=
  "$bin/scree-shape" import "$mesh" -o "$out/$name.stl" --force >"$log" 2>&1 &&
    cpu=$({ time "$bin/scree-train" fit "$out/$name.stl" -o "$out/$name.h5" --name "$name" --force "$@" \
      >>"$log" 2>&1; } 2>&1) &&
    "$bin/scree-shape" inspect "$out/$name.h5" --mesh "$out/$name.stl" >>"$log" 2>&1 &&
    figures "$name" "$cpu" <"$log" | tee -a "$out/table.csv" || {
    echo "$mesh: failed, see $log: $(tail -n 1 "$log")" >&2
    failed=1
  }
done
exit $failed
