# commands_test.py: every command that the documentation shows works: it is run as it is, or as variants.py says.
# Usage: commands_test.py SOURCE PROGRAMS [options of unittest]: checkout and folder of the programs. A minute.
# SPDX-License-Identifier: Apache-2.0
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from variants import VARIANTS

SOURCE, PROGRAMS = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
PROGRAM = r"(scree|scree-shape|scree-train|bench_sdf|bench_step|bench_memory|bench_device)"


def pages(root):
    """Markdown files of a checkout, relative to it; build folders and hidden ones are left out."""
    found = [p.relative_to(root) for p in root.rglob("*.md")]
    return sorted(p for p in found if not p.parts[0].startswith((".", "build")))


def blocks_of(text):
    """Fenced blocks as (what stands behind the fence, line number of the first line, lines)."""
    blocks, inside = [], False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            inside = not inside
            if inside:
                blocks.append((line[3:].strip(), number + 1, []))
        elif inside:
            blocks[-1][2].append(line)
    return blocks


def without_comment(line):
    """A shell line less its comment (a # that begins a word outside quotes), words one space apart."""
    out, quote = "", ""
    for c in line:
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c == "#" and (not out or out[-1] == " "):
            break
        elif c == " " and (not out or out[-1] == " "):
            continue
        out += c
    return out.strip()


def commands_of(lines):
    """Commands of a block: lines joined where one ends in a backslash; a here-document is one command with its text."""
    commands, i = [], 0
    while i < len(lines):
        here = re.search(r"<<'(\w+)'", lines[i])
        if here:
            end = lines.index(here.group(1), i)
            commands.append("\n".join(lines[i:end + 1]) + "\n")
            i = end + 1
            continue
        line = lines[i]
        while line.endswith("\\"):
            i += 1
            line = line[:-1] + lines[i]
        line = without_comment(line)
        if line:
            commands.append(line)
        i += 1
    return commands


def calls_of(text):
    """Calls of our programs in a command or in text: (program, subcommand or "", options without values)."""
    if not re.match(r"(\w+=\S+ )*" + PROGRAM + r"(?= |$)", text):
        return []
    words = re.sub(r"'[^']*'|\"[^\"]*\"", "_", text).split()
    while "=" in words[0]:
        words.pop(0)
    has_command = len(words) > 1 and re.fullmatch(r"[a-z]+", words[1]) and not words[0].startswith("bench")
    command = words[1] if has_command else ""
    options = [re.sub(r"=.*", "", w) for w in words[1:] if re.match(r"--?[a-z]", w)]
    return [(words[0], command, options)]


def help_has(text, option):
    return re.search(r"(?<![\w-])" + re.escape(option) + r"(?![\w-])", text) is not None


def instead_of(page, command, rows):
    """What is run for a command of a page; marks the row of the table as used."""
    for row in rows:
        if row[:2] == (page, command):
            rows[row] = True
            return row[2].replace("...", command) if "..." in row[2] else row[2]
    return command


class Documentation(unittest.TestCase):
    def test_commands_run(self):
        rows = dict.fromkeys(VARIANTS, False)
        count = 0
        for page in map(str, pages(SOURCE)):
            blocks = [b for b in blocks_of((SOURCE / page).read_text()) if b[0] == "sh"]
            if not blocks:
                continue
            with self.subTest(page=page), tempfile.TemporaryDirectory() as folder:
                checkout = Path(folder) / "checkout"  # a copy: what commands write does not come into the source
                shutil.copytree(SOURCE, checkout, ignore=shutil.ignore_patterns(".*", "build*", "*.png"))
                (checkout / "build/cpu").mkdir(parents=True)
                (checkout / "build/cpu/bin").symlink_to(PROGRAMS)
                environment = dict(os.environ, PATH=f"{PROGRAMS}:{os.environ['PATH']}", SCREE_CACHE=f"{folder}/cache")
                for _, line, lines in blocks:
                    for command in commands_of(lines):
                        run = instead_of(page, command, rows)
                        done = subprocess.run(["bash", "-c", run], cwd=checkout, env=environment, text=True,
                                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
                        self.assertEqual(done.returncode, 0, f"{page}:{line}: {run}\n{done.stdout[-3000:]}")
                        count += 1
        self.assertGreater(count, 50)
        self.assertEqual([row[:2] for row, used in rows.items() if not used], [], "rows of VARIANTS for nothing")

    def test_commands_stand_in_marked_blocks(self):
        for page in pages(SOURCE):
            for mark, line, lines in blocks_of((SOURCE / page).read_text()):
                if mark == "sh":
                    continue
                for text in lines:
                    self.assertEqual(calls_of(text), [], f"{page}:{line}: a command in a block without the mark sh")

    def test_options_of_blocks_and_text_exist(self):
        helps, count = {}, 0
        for page in pages(SOURCE):
            text = (SOURCE / page).read_text()
            shown = [c for mark, _, lines in blocks_of(text) if mark == "sh" for c in commands_of(lines)]
            shown += re.findall(r"`([^`\n]+)`", re.sub(r"(?ms)^```.*?^```", "", text))
            for program, command, options in (call for piece in shown for call in calls_of(piece)):
                if not command and not program.startswith("bench"):
                    continue  # a program is only named
                key = " ".join([program, command, "--help"])
                if key not in helps:
                    done = subprocess.run([PROGRAMS / program, *key.split()[1:]], text=True, capture_output=True,
                                          check=False)
                    self.assertEqual(done.returncode, 0, f"{page}: {key}")
                    helps[key] = done.stdout
                for option in options:
                    self.assertTrue(help_has(helps[key], option), f"{page}: {key} has no {option}")
                    count += 1
        self.assertGreater(count, 50)


class Readers(unittest.TestCase):
    """The functions above on texts with known answers."""

    def test_blocks_and_commands(self):
        blocks = blocks_of("text\n```sh\n# nothing\na 'b # c'   d  # e\nf \\\n  g\ncat > x <<'END'\n[h]  # i\nEND\n"
                           "```\n```\nj\n```\n")
        self.assertEqual([b[:2] for b in blocks], [("sh", 3), ("", 12)])
        self.assertEqual(commands_of(blocks[0][2]), ["a 'b # c' d", "f g", "cat > x <<'END'\n[h]  # i\nEND\n"])

    def test_calls(self):
        self.assertEqual(calls_of("A=b scree run 'x y.toml' --set k=-1 -o=c --force"),
                         [("scree", "run", ["--set", "-o", "--force"])])
        self.assertEqual(calls_of("bench_sdf --rounds 3"), [("bench_sdf", "", ["--rounds"])])
        self.assertEqual(calls_of("ls scree"), [])
        self.assertTrue(help_has("  -o,--output TEXT", "-o") and help_has("  -o,--output TEXT", "--output"))
        self.assertFalse(help_has("  --outputs TEXT", "--output") or help_has("  --per-grain", "-grain"))

    def test_variants(self):
        rows = dict.fromkeys([("a.md", "b c", "... -d", ""), ("a.md", "e", "f", "")], False)
        self.assertEqual([instead_of("a.md", c, rows) for c in ("b c", "g")], ["b c -d", "g"])
        self.assertEqual(list(rows.values()), [True, False])
        self.assertEqual(instead_of("h.md", "e", rows), "e")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
