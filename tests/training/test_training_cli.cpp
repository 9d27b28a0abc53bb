// test_training_cli.cpp: scree-train and scree-shape as a user meets them: files, exit codes, one clear message.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "shapes/mesh/icosphere.h"
#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_report.h"
#include "shapes/model_file.h"
#include "tests/support/pebble_decoder.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::string contents(fs::path const& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class TrainingPrograms : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_cli_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    TriangleMesh mesh = icosphere(2);
    for (Vec3& v : mesh.vertex) v.x *= 1.4;
    write_mesh(folder_ / "closed.stl", mesh);
    mesh.triangle.pop_back();
    write_mesh(folder_ / "open.stl", mesh);
    mesh.triangle.resize(mesh.triangle.size() / 2);
    write_mesh(folder_ / "half.stl", mesh);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Exit code; what the program said, both streams, is in said_.
  int run(std::string const& program, std::string const& arguments) {
    fs::path const log = folder_ / "said.txt";
    std::string const command = "cd '" + folder_.string() + "' && '" + program + "' " + arguments + " > said.txt 2>&1";
    int const status = std::system(command.c_str());
    said_ = contents(log);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  bool says(std::string const& text) const { return said_.find(text) != std::string::npos; }

  fs::path folder_;
  std::string said_;
  std::string const tiny_ = " --layers 2 --width 16 --rows 128 --samples 2000 ";
};

TEST_F(TrainingPrograms, FitThenInspect) {
  ASSERT_EQ(run(SCREE_TRAIN, "fit closed.stl -o rock.h5 --steps 300" + tiny_), 0) << said_;
  Library const library = read_model(folder_ / "rock.h5");
  ASSERT_EQ(library.shape.size(), 1u);
  EXPECT_EQ(library.shape[0].name, "closed");
  EXPECT_EQ(library.shape[0].certificate.source, "mesh closed.stl");
  EXPECT_GT(library.shape[0].certificate.mae, 0);
  EXPECT_EQ(run(SCREE_SHAPE, "inspect rock.h5 --nodes 200"), 0) << said_;
  EXPECT_TRUE(says("closed")) << said_;

  std::string const before = contents(folder_ / "rock.h5");
  EXPECT_EQ(run(SCREE_TRAIN, "fit closed.stl -o rock.h5 --steps 3" + tiny_), 2);
  EXPECT_TRUE(says("--force")) << said_;
  EXPECT_EQ(contents(folder_ / "rock.h5"), before);
  EXPECT_EQ(run(SCREE_SHAPE, "inspect rock.h5 --shape nobody"), 2);

  // Damage: half a file, and a byte changed.
  std::ofstream(folder_ / "short.h5", std::ios::binary) << before.substr(0, before.size() / 2);
  EXPECT_EQ(run(SCREE_SHAPE, "inspect short.h5"), 2) << said_;
  EXPECT_TRUE(says("short.h5")) << said_;
  std::string changed = before;
  changed[changed.size() / 2] = static_cast<char>(changed[changed.size() / 2] ^ 1);
  std::ofstream(folder_ / "changed.h5", std::ios::binary) << changed;
  EXPECT_EQ(run(SCREE_SHAPE, "inspect changed.h5"), 2) << said_;
}

TEST_F(TrainingPrograms, EncodeAMesh) {
  write_model(folder_ / "pebbles.h5", test::pebble_library());
  std::string const few = " --samples 500 --nearest 0";
  ASSERT_EQ(run(SCREE_TRAIN, "encode pebbles.h5 closed.stl -o new.h5" + few), 0) << said_;
  EXPECT_TRUE(says("mean of flat, turned about z")) << said_;
  EXPECT_TRUE(says("'closed', MAE ")) << said_;
  Library const made = read_model(folder_ / "new.h5");
  ASSERT_EQ(made.shape.size(), 1u);
  EXPECT_EQ(made.net.size(), 1u);
  EXPECT_EQ(made.shape[0].code.size(), 2u);
  EXPECT_EQ(made.shape[0].certificate.source, "mesh closed.stl, encoded by pebbles.h5");
  EXPECT_GT(made.shape[0].certificate.mae, 0);
  EXPECT_EQ(made.shape[0].certificate.components, 1);

  EXPECT_EQ(run(SCREE_TRAIN, "encode pebbles.h5 closed.stl -o new.h5" + few), 2);
  EXPECT_TRUE(says("--force")) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "encode pebbles.h5 closed.stl -o both.h5 --keep --name long/9" + few), 0) << said_;
  EXPECT_EQ(read_model(folder_ / "both.h5").shape.back().name, "long/9");
  EXPECT_EQ(read_model(folder_ / "both.h5").shape.size(), 8u);
  EXPECT_EQ(run(SCREE_TRAIN, "encode both.h5 closed.stl -o more.h5 --keep --name long/9" + few), 2);
  EXPECT_TRUE(says("has a shape 'long/9' already")) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "encode pebbles.h5 open.stl -o more.h5" + few), 2);
  EXPECT_TRUE(says("open along 3 edges")) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "encode closed.stl closed.stl -o more.h5" + few), 2);
  EXPECT_TRUE(says("closed.stl")) << said_;
  EXPECT_FALSE(fs::exists(folder_ / "more.h5"));
}

TEST_F(TrainingPrograms, BadInputGetsOneMessageAndLeavesNothing) {
  EXPECT_EQ(run(SCREE_TRAIN, "fit nowhere.stl -o rock.h5"), 2);
  EXPECT_TRUE(says("nowhere.stl")) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "fit open.stl -o rock.h5"), 2);
  EXPECT_TRUE(says("open along 3 edges")) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "fit closed.stl -o rock.h5 --width 65"), 2);
  EXPECT_EQ(run(SCREE_TRAIN, "fit closed.stl -o rock.h5 --steps 10 --seconds 1"), 2);
  EXPECT_EQ(run(SCREE_TRAIN, "fit closed.stl"), 2);
  EXPECT_EQ(run(SCREE_TRAIN, "fit closed.stl -o nowhere/rock.h5"), 4);
  EXPECT_TRUE(says("nowhere")) << said_;
  EXPECT_EQ(run(SCREE_SHAPE, "inspect nowhere.h5"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "rock.h5"));
  EXPECT_EQ(run(SCREE_TRAIN, "--version"), 0);
  EXPECT_TRUE(says("GPL-3")) << said_;
}

TEST_F(TrainingPrograms, ImportRepairsAndRefuses) {
  EXPECT_EQ(run(SCREE_SHAPE, "import open.stl -o clean.stl --normalise"), 0) << said_;
  EXPECT_TRUE(says("filled a hole of 3 edges")) << said_;
  EXPECT_TRUE(check_mesh(read_mesh(folder_ / "clean.stl")).defects.empty());
  EXPECT_EQ(run(SCREE_SHAPE, "import half.stl -o half_clean.stl --largest-hole 4"), 2);
  EXPECT_TRUE(says("open")) << said_;
  EXPECT_FALSE(fs::exists(folder_ / "half_clean.stl"));
  EXPECT_EQ(run(SCREE_SHAPE, "import open.stl -o clean.stl"), 2);
  EXPECT_TRUE(says("--force")) << said_;
}

// Each defect is named with a place and the repair, by both programs; import mends it, and so does fit --repair.
TEST_F(TrainingPrograms, EveryDefectIsNamedAndMended) {
  TriangleMesh const good = icosphere(2);
  TriangleMesh open = good, fin = good, inside_out = good, two = good;
  open.triangle.pop_back();
  fin.vertex.push_back({3, 3, 3});
  fin.triangle.push_back({good.triangle[0][0], good.triangle[0][1], static_cast<int>(fin.vertex.size()) - 1});
  for (auto& t : inside_out.triangle) std::swap(t[0], t[1]);
  int const first = static_cast<int>(good.vertex.size());
  TriangleMesh const small = icosphere(0);
  for (Vec3 const& v : small.vertex) two.vertex.push_back(v * 0.1 + Vec3{7, 0, 0});
  for (auto const& t : small.triangle) two.triangle.push_back({first + t[0], first + t[1], first + t[2]});
  struct Defect {
    char const* file;
    TriangleMesh const& mesh;
    char const* name;
    char const* place;  // where both programs see it
    char const* mended;
  };
  for (Defect const& d : {Defect{"hole.stl", open, "is open along 3 edges", "one at (", "filled a hole of 3 edges"},
                          Defect{"fin.stl", fin, "is non-manifold", "one at (", "smaller parts"},
                          Defect{"turned.stl", inside_out, "is inside out", "", "right side out"},
                          Defect{"two.stl", two, "has 2 separate parts", "one at (", "removed 1 smaller parts"}}) {
    write_mesh(folder_ / d.file, d.mesh);
    std::string const file = d.file;
    EXPECT_EQ(run(SCREE_TRAIN, "fit " + file + " -o rock.h5"), 2);
    for (char const* part : {d.file, d.name, d.place, "scree-shape import", "--repair"})
      EXPECT_TRUE(says(part)) << part << " | " << said_;
    EXPECT_EQ(run(SCREE_SHAPE, "import " + file + " -o mended_" + file), 0) << said_;
    for (char const* part : {d.name, d.place, d.mended}) EXPECT_TRUE(says(part)) << part << " | " << said_;
    EXPECT_TRUE(check_mesh(read_mesh(folder_ / ("mended_" + file))).defects.empty()) << file;
  }
  ASSERT_EQ(run(SCREE_TRAIN, "fit fin.stl --repair -o rock.h5 --steps 100" + tiny_), 0) << said_;
  for (char const* part : {"is non-manifold", "smaller parts", "errors", "falling"}) EXPECT_TRUE(says(part)) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "fit half.stl --repair -o half.h5 --steps 3" + tiny_), 2);
  EXPECT_TRUE(says("--largest-hole")) << said_;

  TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  write_mesh(folder_ / "sheet.stl", sheet);
  EXPECT_EQ(run(SCREE_SHAPE, "import sheet.stl -o thick.stl"), 2);
  EXPECT_TRUE(says("encloses no volume")) << said_;
}

TEST_F(TrainingPrograms, StudyWritesItsTableAndPicture) {
  ASSERT_EQ(run(SCREE_TRAIN, "study coded-convergence --quick -o out"), 0) << said_;
  std::istringstream csv(contents(folder_ / "out/coded-convergence.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "recipe,shape,epoch,step,train_mae,test_mae,kept");
  int kept = 0, rows = 0;
  for (; std::getline(csv, line); ++rows) kept += line.ends_with(",1");
  EXPECT_EQ(kept, 8);  // two recipes, four shapes
  EXPECT_GT(rows, kept);
  bool const matplotlib = std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") == 0;
  EXPECT_EQ(fs::exists(folder_ / "out/coded-convergence.png"), matplotlib);
  EXPECT_EQ(says("python3-matplotlib"), !matplotlib) << said_;
}

TEST_F(TrainingPrograms, StudiesAndDataSetsAreNamed) {
  EXPECT_EQ(run(SCREE_TRAIN, "study --list"), 0) << said_;
  for (char const* name : {"superellipsoids", "Fig. 11", "memory", "Table 1"}) EXPECT_TRUE(says(name)) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "study nothing -o out"), 2);
  EXPECT_TRUE(says("query-time")) << said_;
  EXPECT_EQ(run(SCREE_TRAIN, "study"), 2);
  EXPECT_EQ(run(SCREE_TRAIN, "study coded-grains --quick --library closed.stl -o made"), 2);
  EXPECT_EQ(run(SCREE_TRAIN, "dataset nothing -o out"), 2);
  EXPECT_EQ(run(SCREE_TRAIN, "dataset grains20 -o closed.stl"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  ASSERT_EQ(run(SCREE_TRAIN, "dataset grains20 -o grains"), 0) << said_;
  EXPECT_TRUE(report_mesh(read_mesh(folder_ / "grains/sand-4.stl")).defects.empty());
  std::string const table = contents(folder_ / "grains/grains20.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 21);
}

}  // namespace
}  // namespace scree
