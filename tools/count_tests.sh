# count_tests.sh: run_tests BUILD_FOLDER: ctest with two jobs; sets `passed` and `failed`. Sourced by test.sh and .ci/run.
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=sh disable=SC2034

passed=0
failed=0

# Adds to `passed` and `failed`; status 0 only when tests ran and none failed. Counts come from ctest's JUnit file,
# which also holds what a crash of ctest's own leaves out: no file, no success.
run_tests() {
  report="$(cd "$1" && pwd)/ctest.xml"
  rm -f "$report"
  ctest --test-dir "$1" --output-on-failure -j2 --output-junit "$report" || true
  if [ ! -f "$report" ]; then
    echo "error: ctest wrote no report" >&2
    failed=$((failed + 1))
    return 1
  fi
  total=$(sed -n 's/.*[^a-z]tests="\([0-9]*\)".*/\1/p' "$report" | head -n 1)
  bad=$(sed -n 's/.*failures="\([0-9]*\)".*/\1/p' "$report" | head -n 1)
  skipped=$(sed -n 's/.*skipped="\([0-9]*\)".*/\1/p' "$report" | head -n 1)
  failed=$((failed + bad))
  passed=$((passed + total - bad - skipped))
  [ "$total" -gt 0 ] && [ "$bad" -eq 0 ]
}
