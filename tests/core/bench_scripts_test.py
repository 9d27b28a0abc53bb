# bench_scripts_test.py: the arithmetic of bench_compare.sh and bench_opponents.py on numbers that are known.
# Usage: bench_scripts_test.py SOURCE
# SPDX-License-Identifier: Apache-2.0
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE = os.path.abspath(sys.argv.pop(1))
TOOLS = os.path.join(SOURCE, 'tools')
sys.path.insert(0, TOOLS)
import bench_opponents  # noqa: E402
import bench_ratios  # noqa: E402

# Writes JSON whose times are FACTOR x 10, x 20, x 30, ... from round to round.
FAKE = '''#!/bin/sh
n=$(($(cat "$0.count" 2>/dev/null || echo 0) + 1)); echo $n > "$0.count"
while [ "$1" != --output ]; do shift; done
echo "{\\"results\\": [{\\"scene\\": \\"rest\\", \\"cpu_us\\": $((FACTOR * 10 * n))}], \\"other\\": $n}" > "$2"
'''


class Ratios(unittest.TestCase):

    def test_medians_of_ratios_within_rounds(self):
        def round_of(us, rate):
            return bench_ratios.figures({'r': [{'scene': 'x', 'cpu_us': us}], 'queries_per_s': rate, 'n': 5})

        table = bench_ratios.ratios([round_of(1, 8), round_of(100, 8), round_of(10, 8)],
                                    [round_of(2, 4), round_of(110, 4), round_of(30, 16)])
        self.assertEqual(set(table), {'r/x/cpu_us', 'queries_per_s'})
        for got, expected in zip(table['r/x/cpu_us'], (2, 1.1, 3)):
            self.assertAlmostEqual(got, expected)
        self.assertEqual(table['queries_per_s'], (2, 0.5, 2))  # half as many are twice the time

    def compare(self, factors, *options):
        with tempfile.TemporaryDirectory() as scratch:
            folders = []
            for name, factor in zip('ab', factors):
                folders.append(os.path.join(scratch, name))
                os.mkdir(folders[-1])
                program = os.path.join(folders[-1], 'bench_fake')
                with open(program, 'w') as f:
                    f.write(FAKE.replace('FACTOR', str(factor)))
                os.chmod(program, 0o755)
            command = [os.path.join(TOOLS, 'bench_compare.sh'), *folders, *options, '--', 'bench_fake', '--all']
            return subprocess.run(command, text=True, capture_output=True)

    def test_interleaved_rounds_of_two_folders_and_the_limit(self):
        done = self.compare((10, 12), '--rounds', '3', '--limit', '1.25')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('| results/rest/cpu_us | 1.200 | 1.200 | 1.200 |', done.stdout)
        done = self.compare((10, 12), '--rounds', '3', '--limit', '1.1')
        self.assertEqual(done.returncode, 1)
        self.assertIn('1.200 is above the limit 1.1', done.stdout)
        self.assertEqual(self.compare((12, 10), '--rounds', '1', '--limit', '1').returncode, 0)

    def test_a_program_that_is_not_there_is_an_error(self):
        done = subprocess.run([os.path.join(TOOLS, 'bench_compare.sh'), '/', '/', '--', 'no_such_bench'],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn('no_such_bench', done.stderr)


class Opponents(unittest.TestCase):

    def test_ratios_are_those_of_rounds(self):
        rows = bench_opponents.compare({'ours': [1, 2, 4], 'theirs': [3, 2, 2]}, 100)
        self.assertEqual([r['particle_steps_per_second'] for r in rows], [50, 50])
        self.assertEqual(rows[0]['first_over_this'], 1)
        self.assertEqual((rows[1]['first_over_this'], rows[1]['lowest'], rows[1]['highest']), (1, 0.5, 3))

    def test_the_last_loop_of_a_log_counts(self):
        log = 'Loop time of 9.5 on 1 procs for 1 steps\nLoop time of 0.0582 on 1 procs for 500 steps with 500 atoms'
        self.assertEqual(bench_opponents.loop_seconds(log), 0.0582)
        with self.assertRaises(ValueError):
            bench_opponents.loop_seconds('ERROR: no atoms')

    def test_what_is_not_there_is_said(self):
        subjects = [('ours', None, lambda: 1), ('theirs', 'no_such_program_at_all', lambda: 2)]
        said = []
        left = bench_opponents.installed(subjects, said.append)
        self.assertEqual([name for name, _ in left], ['ours'])
        self.assertEqual(said, ['theirs: no_such_program_at_all is not installed'])


if __name__ == '__main__':
    unittest.main()
