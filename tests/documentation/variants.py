# variants.py: what the test of the documentation runs instead of a command that takes long, installs or needs much.
# SPDX-License-Identifier: Apache-2.0
"""One table, VARIANTS: page, command as the page shows it, what is run instead, and why.

"..." in the place of the command stands for the command itself: "... --quick" appends an option. Every other command of
the documentation runs as it is shown. A row whose command its page no longer shows fails the test.
"""

COARSE = "... --set grains.mix.nodes=100 --set 'grains.mix.shapes=[\"grains:cobble/*\"]'"
FEW = COARSE + " --set grains.mix.count=12 --set time.end=0.002 --threads 1"
SAND = "... --set grains.mix.nodes=100 --set grains.mix.count=12 --set time.end=0.002 --threads 1"
# Rocks of the library in all three groups: making new ones takes 20 s.
ROCKS = ("... --set grains.interpolation.interpolate= --set 'grains.interpolation.shapes=[\"grains:ballast/*\"]' "
         "--set grains.sampling.sample= --set 'grains.sampling.shapes=[\"grains:ballast/*\"]' "
         "--set time.end=0.05 --set output.every=0.02 --threads 1")
# A plane slope in place of the measured terrain: 231 x 261 cells of 1 m.
SLOPE = ("mkdir -p FOLDER && /usr/bin/python3 -c \"print('ncols 231\\nnrows 261\\nxllcorner 0\\nyllcorner 0\\n"
         "cellsize 1\\nnodata_value -9999'); [print(*[1600 + 0.3 * (260 - j)] * 231) for j in range(261)]\" "
         "> FOLDER/terrain.asc && ...")
# The ball falls at once.
BALL = "--set grains.ball.insert.start=0.0005 --set time.end=0.001 --set output.every=0.001 --threads 1"
FIGURES = "...; test $? -le 1"  # 1: outside of what is expected
INSTALLS = "installs packages and builds for minutes: its syntax"
MINUTES = "takes minutes"
BUILDS = "builds for minutes: that what it names is there"

VARIANTS = [
    ("README.md", "tools/quickstart.sh", "sh -n tools/quickstart.sh", INSTALLS),
    ("README.md", "tools/test.sh", "sh -n tools/test.sh", INSTALLS),
    ("README.md", "scree check cases/packing/mix.toml", COARSE, "fewer nodes than 80,000"),
    ("README.md", "scree plan cases/packing/mix.toml", COARSE, "fewer nodes than 80,000"),
    ("README.md", "scree run cases/packing/mix.toml --output out", FEW, MINUTES),
    ("README.md", "scree render out/results.h5 -o picture.png", "... --size 160x120 --threads 1", "a small picture"),
    ("README.md", "scree run cases/packing/mix.toml --set 'grains.mix.shapes=[\"grains:sand/*\"]' --output sand",
     SAND, MINUTES),
    ("README.md", "scree-train fit ellipsoid:1.5:1.25:1 --layers 3 --width 16 --steps 4000 -o 3x16-sine.h5",
     "scree-train fit --help", "trains for a minute"),
    ("README.md", "scree-train fit ellipsoid:1.5:1.25:1 -o 5x40-sine.h5", "scree-train fit --help", MINUTES),
    ("README.md", "scree cost -o cost.out --net 3x16-sine.h5 --net 5x40-sine.h5", "scree cost --quick -o cost.out",
     MINUTES),
    ("cases/README.md", "scree run cases/packing/mix.toml --output out", FEW, MINUTES),
    ("cases/README.md", "scree info out/results.h5 --expected cases/packing/expected.toml",
     FIGURES, "of a run cut short"),
    ("cases/TUTORIAL.md", "scree run bed.toml --output slippery --set contact.0.friction=0.1 --quiet",
     "... --set time.end=0.1", "its first run is run whole, this one is like it"),
    ("cases/drum/README.md", "scree run cases/drum/ballast.toml --output drum.out",
     "... --set time.end=0.01 --set grains.ballast.nodes=100 --threads 1", MINUTES),
    ("cases/drum/README.md", "scree render drum.out/results.h5 -o drum.png --azimuth -78 --elevation 14",
     "... --size 160x120 --threads 1", "a small picture"),
    ("cases/funnel/README.md", "scree run cases/funnel/ballast.toml --output funnel.out",
     "... --set time.end=0.01 --set grains.ballast.nodes=100 --threads 1", MINUTES),
    ("cases/funnel/README.md", "scree info funnel.out/results.h5 --expected cases/funnel/expected.toml", FIGURES,
     "of a run cut short"),
    ("cases/funnel/README.md",
     "scree run cases/funnel/ballast.toml --output full.out --set grains.ballast.count=12000 --set time.end=140",
     "... --set time.end=0.001 --set grains.ballast.nodes=100 --threads 1", "takes days"),
    ("cases/morph/README.md", "/usr/bin/python3 cases/morph/morph.py build/cpu/bin/scree morph.out",
     "/usr/bin/python3 cases/morph/morph.py --help", "30 runs of minutes"),
    ("cases/packing/README.md", "scree run cases/packing/mix.toml --output mix.out", FEW, MINUTES),
    ("cases/packing/README.md",
     "scree run cases/packing/mix.toml --output sand.out --set 'grains.mix.shapes=[\"grains:sand/*\"]'", SAND, MINUTES),
    ("cases/penetration/README.md", "scree run cases/penetration/deep.toml --output penetration.out",
     "... --set grains.bed.count=100 " + BALL, "takes days"),
    ("cases/penetration/README.md",
     "scree run cases/penetration/deep.toml --output small.out --set grains.bed.count=800 --set grains.bed.diameter=0.01 "
     "--set contact.0.normal.youngs_modulus=5e6 --set contact.1.normal.youngs_modulus=1e7 "
     "--set contact.2.normal.youngs_modulus=1e7 --set limits.overlap=0.4 --set grains.ball.insert.start=0.35 "
     "--set time.end=0.45 --set time.safety=0.5", "... " + BALL, "takes a minute"),
    ("cases/slope/README.md", "scree run cases/slope/rockfall.toml --output slope.out",
     ROCKS, MINUTES),
    ("cases/slope/README.md", "scree info slope.out/results.h5 --expected cases/slope/expected.toml", FIGURES,
     "of a run cut short"),
    ("cases/slope/README.md", "scree render slope.out/results.h5 -o slope.png --frame 120 --azimuth -35 --elevation 35",
     "scree render slope.out/results.h5 -o slope.png --frame 0 --azimuth -35 --elevation 35 --size 160x120 --threads 1",
     "of a run cut short, a small picture"),
    ("cases/slope/README.md", "scree run cases/slope/rockfall.toml --output many.out --set case.replicas=5",
     ROCKS + " --set case.replicas=2", MINUTES),
    ("cases/slope/README.md",
     "/usr/bin/python3 cases/slope/release.py FOLDER/terrain.asc --from 152,224 --to 188,196 -o FOLDER/terrain-release.csv",
     SLOPE, "the terrain is not part of the project"),
    ("cases/slope/README.md", "SCREE_LIBRARY=FOLDER scree run cases/slope/terrain.toml --output terrain.out",
     ROCKS, MINUTES),
    ("shapes/exchange/README.md", "scree-train export grains.h5 --format safetensors -o grains.safetensors",
     "cp shapes/library/grains.h5 . && ...", "of the shipped library"),
    ("shapes/exchange/README.md", "scree-shape import grains.safetensors -o grains.h5", "... --force",
     "beside the file it comes from"),
    ("shapes/exchange/README.md",
     "scree-shape import theirs.safetensors -o theirs.h5 --activation sine --parameter 30 --negative-inside",
     "test -n \"$(scree-shape import --help | grep negative-inside)\"", "a network of another program is not here"),
    ("shapes/exchange/README.md", "python3 -m venv venv && venv/bin/pip install onnxruntime", "python3 -m venv --help",
     "needs a package index"),
    ("shapes/exchange/README.md",
     "SCREE_ONNX_PYTHON=$PWD/venv/bin/python ctest --test-dir build/cpu -R test_shapes_exchange -V",
     "ctest --help", "needs onnxruntime"),
    ("shapes/library/README.md",
     "scree-train coded --set grains20 --steps 60000 --samples 120000 --seed 1 -o shapes/library/grains.h5 --force",
     "scree-train coded --help", "trains for half an hour, and certifies 20 shapes however short the training"),
    ("tests/fuzz/README.md",
     "cmake -S . -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=\"-O1 -gline-tables-only\" "
     "-DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DSCREE_CUDA=OFF -DSCREE_MESH=OFF -DSCREE_TRAINING=OFF "
     "-DSCREE_ONNX=OFF -DSCREE_BENCHMARKS=OFF -DSCREE_FUZZ=ON -DSCREE_SANITIZE=address,undefined,float-cast-overflow",
     "grep -q SCREE_FUZZ CMakeLists.txt", BUILDS),
    ("tests/fuzz/README.md", "cmake --build build/fuzz --target fuzzers",
     "grep -q fuzzers tests/fuzz/CMakeLists.txt", BUILDS),
    ("tests/fuzz/README.md", "tests/fuzz/run.sh 20", "sh -n tests/fuzz/run.sh", "needs the fuzzers: its syntax"),
    ("tests/fuzz/README.md", "tests/fuzz/run.sh 600 build/fuzz ply stl", "sh -n tests/fuzz/run.sh",
     "needs the fuzzers: its syntax"),
    ("tests/fuzz/README.md", "build/cpu/fuzz/replay_ply tests/fuzz/corpus/ply", "test -d tests/fuzz/corpus/ply",
     "replays are tests of their own"),
    ("tests/validation/README.md", "scree validate", "scree validate --list", "the book takes minutes"),
    ("tests/validation/README.md", "scree validate 7 7a needles", "scree validate --list",
     "the book has tests of its own"),
    ("tests/validation/README.md", "scree validate --full", "scree validate --help | grep -q full", "takes hours"),
    ("training/README.md", "scree-shape import scan.stl -o clean.stl",
     "scree-train dataset grains20 -o stones && cp stones/ballast-1.stl scan.stl && ...", "a scan of the reader's"),
    ("training/README.md", "scree-train fit clean.stl -o rock.h5 --seconds 60",
     "scree-train fit clean.stl -o rock.h5 --steps 4 --samples 500 --threads 1", "trains for a minute"),
    ("training/README.md", "scree-train coded --set grains20 -o grains.h5",
     "scree-train coded --help", "trains for minutes"),
    ("training/README.md", "scree-train fit scan.stl --repair -o rock.h5",
     "scree-train fit --help", "trains for a minute; the fit above is run"),
    ("training/README.md", "scree-train encode grains.h5 scan.stl -o new.h5",
     "scree-train encode --help", "takes 10 s even on a library of two shapes; encode has tests of its own"),
    ("training/studies/README.md", "scree-train study layers -o DIR", "scree-train study memory --quick -o DIR",
     "trains for an hour, with --quick for 20 s; the shortest study instead"),
    ("training/studies/README.md", "scree-train study layers --plot-only -o DIR",
     "scree-train study memory --plot-only -o DIR", "the study that was run instead"),
    ("training/studies/README.md", "scree-train study all --quick -o DIR", "scree-train study --list", "takes 90 s"),
    ("training/studies/README.md", "scree-train study coded-grains --library shapes/library/grains.h5 -o DIR",
     "scree-train study --help", "trains for minutes, with --quick still for one"),
    ("training/studies/README.md", "scree-train dataset superellipsoids125 -o DIR", "... --cells 8", "coarser meshes"),
]
