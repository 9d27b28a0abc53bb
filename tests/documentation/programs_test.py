# programs_test.py: tools/programs/NAME.md is what each program prints about itself.
# Usage: programs_test.py SOURCE PROGRAMS; with --write as a third argument it makes the pages.
# SPDX-License-Identifier: Apache-2.0
import re
import subprocess
import sys
from pathlib import Path

ABOUT = {
    "scree": "Runs cases and reads what they leave: needs the engine's packages only. Exit codes and output folder: "
             "[tools](../README.md#options-and-exit-codes).",
    "scree-shape": "Meshes, model files and new shapes: needs CGAL. In use: [tutorial](../../cases/TUTORIAL.md), "
                   "[tools](../README.md#scree-shape).",
    "scree-train": "Fits networks to shapes: needs LibTorch and CGAL. In use: [tutorial](../../cases/TUTORIAL.md), "
                   "[training](../../training/README.md).",
    "bench_sdf": "Network queries per second on one core: needs Google Benchmark.",
    "bench_step": "Cost of a whole step, by stage and by number of threads: needs Google Benchmark.",
    "bench_scaling": "Cost of a grain and step by the number of grains: is built with the other benchmarks.",
    "bench_broad_phase": "Pairs of overlapping boxes: needs Google Benchmark; CGAL is compared with where it is there.",
    "bench_training": "Speed of the training: is built with `scree-train`.",
    "bench_memory": "Bytes of a grain: is built with the other benchmarks.",
    "bench_device": "The network kernel on a GPU: built with `SCREE_CUDA=ON` it measures, without it "
                    "`--device emulated` tries the program.",
}


def help_of(program, *command):
    done = subprocess.run([program, *command, "--help"], text=True, capture_output=True, check=True)
    # How the program was called says nothing; nor do spaces at the end of a line.
    text = done.stdout.replace(str(program), program.name)
    return "\n".join(line.rstrip() for line in text.strip().splitlines())


def page_of(program):
    """A page: the program's help, then that of each subcommand."""
    main = help_of(program)
    page = f"# {program.name}\n\n{ABOUT[program.name]} Made from the program's own `--help`; a test compares.\n\n"
    page += f"```\n{main}\n```\n"
    listed = main.split("\nSubcommands:\n")[1] if "\nSubcommands:\n" in main else ""
    for command in re.findall(r"(?m)^  (\w[\w-]*)  ", listed):
        page += f"\n## {program.name} {command}\n\n```\n{help_of(program, command)}\n```\n"
    return page


def main():
    source, programs = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    stale = []
    for name in ABOUT:
        program, file = programs / name, source / "tools/programs" / f"{name}.md"
        if not program.exists():
            print(f"{name} is not in this build: its page was not compared")
            continue
        page = page_of(program)
        if sys.argv[3:] == ["--write"]:
            file.parent.mkdir(exist_ok=True)
            file.write_text(page)
        elif not file.exists() or file.read_text() != page:
            stale.append(name)
    if stale:
        sys.exit(f"pages that differ from --help: {', '.join(stale)}; make them anew: "
                 f"{sys.argv[0]} {sys.argv[1]} {sys.argv[2]} --write")


if __name__ == "__main__":
    main()
