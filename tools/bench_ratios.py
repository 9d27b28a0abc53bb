#!/usr/bin/env python3
# bench_ratios.py: runs one benchmark of two builds in turn and prints the ratios of its times; bench_compare.sh builds.
# SPDX-License-Identifier: Apache-2.0
"""usage: bench_ratios.py A B [--rounds N] [--limit R] -- PROGRAM OPTIONS...

A, B: folders with PROGRAM, a benchmark that writes JSON. Each round runs it in A and in B. A figure is a number of that JSON
whose name says what it is (FIGURES); of each, the median ratio of B's time to A's in the same round, with the lowest and the
highest. Exit code 1: a median is above R (0: never); 2: a program failed or nothing could be compared.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

# Name of a figure -> 1: it is a time, -1: so many a time.
FIGURES = {'cpu_us_per_step': 1, 'cpu_us': 1, 'cpu_time': 1, 'seconds': 1, 'queries_per_s': -1}


def figures(data, path=''):
    """Path -> (value, sign) of all figures in parsed JSON. A list's entries are known by what they say of themselves."""
    out = {}
    if isinstance(data, dict):
        for key, value in data.items():
            if key in FIGURES and isinstance(value, (int, float)):
                out[path + key] = (float(value), FIGURES[key])
            else:
                out.update(figures(value, path + key + '/'))
    elif isinstance(data, list):
        for i, entry in enumerate(data):
            known = entry if isinstance(entry, dict) else {}
            words = [str(known[k]) for k in ('name', 'scene', 'grains', 'threads') if k in known]
            out.update(figures(entry, path + (' '.join(words) or str(i)) + '/'))
    return out


def ratios(first, second):
    """Path -> (median, lowest, highest) of B's time over A's; first, second: what figures() gave in each round of A, of B."""
    out = {}
    for path in first[0]:
        if not all(path in round_ and round_[path][0] > 0 for round_ in first + second):
            continue
        each = [(b[path][0] / a[path][0])**a[path][1] for a, b in zip(first, second)]
        out[path] = (statistics.median(each), min(each), max(each))
    return out


def run(folder, command):
    program = os.path.join(folder, command[0])
    with tempfile.TemporaryDirectory() as scratch:
        file = os.path.join(scratch, 'out.json')
        # Programs on Google Benchmark alone write JSON by its own flag.
        flags = ['--benchmark_out=' + file] if command[0] == 'bench_broad_phase' else ['--output', file]
        try:
            done = subprocess.run([program] + command[1:] + flags, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT)
        except OSError as error:
            sys.stderr.write('%s: %s\n' % (program, error.strerror))
            sys.exit(2)
        if done.returncode != 0 or not os.path.exists(file):
            sys.stderr.write('%s failed:\n%s\n' % (program, done.stdout[-2000:]))
            sys.exit(2)
        with open(file) as f:
            return figures(json.load(f))


def main(arguments):
    at = arguments.index('--') if '--' in arguments else len(arguments)
    command = arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('a')
    parser.add_argument('b')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--limit', type=float, default=0)
    a = parser.parse_args(arguments[:at])
    if not command:
        parser.error('-- PROGRAM is missing')
    first, second = [], []
    for _ in range(a.rounds):
        first.append(run(a.a, command))
        second.append(run(a.b, command))
    table = ratios(first, second)
    if not table:
        sys.stderr.write('nothing to compare: the JSON has none of %s\n' % ', '.join(FIGURES))
        return 2
    print('| figure | B / A, median of %d rounds | lowest | highest |\n|---|---|---|---|' % a.rounds)
    for path, (middle, low, high) in table.items():
        print('| %s | %.3f | %.3f | %.3f |' % (path, middle, low, high))
    worst = max(table, key=lambda path: table[path][0])
    if a.limit > 0 and table[worst][0] > a.limit:
        print('%s: %.3f is above the limit %g' % (worst, table[worst][0], a.limit))
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
