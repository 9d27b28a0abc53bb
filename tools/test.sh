#!/bin/sh
# test.sh: installs everything (Debian 12), builds all of Scree and runs all tests.
# The last line is "N passed, N failed"; the exit status is 0 only when nothing failed.
# SPDX-License-Identifier: Apache-2.0
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tools/packages.sh"
. "$root/tools/count_tests.sh"

# shellcheck disable=SC2086 # words are package names
install_packages $engine_packages $test_packages
cmake -S "$root" -B "$root/build/cpu" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSCREE_CUDA=OFF
cmake --build "$root/build/cpu"
status=0
run_tests "$root/build/cpu" || status=$?
echo "$passed passed, $failed failed"
exit $status
