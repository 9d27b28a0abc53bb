// damaged_files_test.cpp: files that are cut short or of another version, of every kind that a run reads.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "shapes/analytic_shapes.h"
#include "shapes/bake_cache.h"
#include "shapes/file_container.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/terrain_file.h"
#include "tests/support/l_prism.h"
#include "tests/support/limited_disk.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void write_file(fs::path const& file, std::string const& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

class DamagedFiles : public ::testing::Test {
 protected:
  DamagedFiles() : folder_(fs::temp_directory_path() / ("scree_damaged_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~DamagedFiles() override { fs::remove_all(folder_); }

  // What `read` complains about; "" where it does not. Complaints begin with the file.
  static std::string complaint(fs::path const& file, std::function<void(fs::path const&)> const& read) {
    try {
      read(file);
    } catch (std::runtime_error const& e) {
      EXPECT_EQ(std::string(e.what()).find(file.string()), 0u) << e.what();
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

std::string ascii_stl(TriangleMesh const& mesh) {
  std::string text = "solid prism\n";
  for (auto const& t : mesh.triangle) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int const v : t) {
      Vec3 const p = mesh.vertex[v];
      text += "vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid prism\n";
}

char const* const terrain = "ncols 3\nnrows 3\ncellsize 0.5\n1 2 3\n4 5 6\n7 8 99\n";

// Formats that say how much there is are refused at every length at which that is not there; of the last number of a
// text, digits can be missing unseen.
TEST_F(DamagedFiles, MeshesAndTerrainsCutAnywhere) {
  TriangleMesh const mesh = l_prism();
  write_mesh(folder_ / "binary.stl", mesh);
  write_mesh(folder_ / "binary.ply", mesh);
  std::string const ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  std::map<std::string, std::string> const whole{{"a.stl", ascii_stl(mesh)},
                                                 {"b.stl", read_file(folder_ / "binary.stl")},
                                                 {"a.ply", ply},
                                                 {"b.ply", read_file(folder_ / "binary.ply")},
                                                 {"a.asc", terrain}};
  for (auto const& [name, bytes] : whole) {
    SCOPED_TRACE(name);
    auto const read = [&](fs::path const& f) { f.extension() == ".asc" ? read_terrain(f) : read_mesh(f); };
    write_file(folder_ / name, bytes);
    ASSERT_EQ(complaint(folder_ / name, read), "");
    std::size_t const last = name == "a.stl"  ? bytes.rfind("endsolid") + 8  // its name may be anything
                             : name[0] == 'a' ? bytes.find_last_of(" ") + 2
                                              : bytes.size();
    std::size_t const step = bytes.size() > 1000 ? 7 : 1;
    for (std::size_t length = 0; length < last; length += step) {
      write_file(folder_ / name, bytes.substr(0, length));
      EXPECT_NE(complaint(folder_ / name, read), "") << "cut at " << length << " of " << bytes.size();
    }
  }
}

// OBJ has neither counts nor an end mark. A closed surface that was cut is open: that check sees what the format hides.
TEST_F(DamagedFiles, CutObjFilesAreRefusedOrOpen) {
  TriangleMesh const mesh = l_prism();
  fs::path const file = folder_ / "m.obj";
  write_mesh(file, mesh);
  std::string const bytes = read_file(file);
  for (std::size_t length = 0; length + 1 < bytes.size(); ++length) {
    write_file(file, bytes.substr(0, length));
    TriangleMesh cut;
    if (!complaint(file, [&](fs::path const& f) { cut = read_mesh(f); }).empty()) continue;
    std::map<std::pair<int, int>, int> uses;
    for (auto const& t : cut.triangle)
      for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}], --uses[{t[(k + 1) % 3], t[k]}];
    bool const closed = std::all_of(uses.begin(), uses.end(), [](auto const& u) { return u.second == 0; });
    EXPECT_FALSE(closed) << "cut at " << length;
  }
}

TEST_F(DamagedFiles, ModelsCutAnywhereAndOfOtherVersions) {
  Library library;
  library.shape = {builtin_shape("ellipsoid:1:0.8:0.6")};
  library.shape[0].name = "egg";
  fs::path const file = folder_ / "m.h5";
  write_model(file, library);
  std::string const bytes = read_file(file);
  auto const read = [](fs::path const& f) { read_model(f); };
  for (std::size_t length = 0; length < bytes.size(); length += length < 600 ? 37 : 211) {
    write_file(file, bytes.substr(0, length));
    EXPECT_NE(complaint(file, read), "") << length;
  }
  write_file(folder_ / "payload", bytes);
  seal_container(folder_ / "payload", file, "scree.model", 3);
  EXPECT_NE(complaint(file, read).find("has format version 3, this program reads up to 2"), std::string::npos);
  write_file(folder_ / "payload", bytes);
  seal_container(folder_ / "payload", file, "scree.results", 1);
  EXPECT_NE(complaint(file, read).find("is a \"scree.results\" file"), std::string::npos);
}

// The cache of baked grids is only a cache: whatever is wrong with a file, it is made again.
TEST_F(DamagedFiles, BakedGridsAreMadeAgain) {
  Library library;
  library.shape = {builtin_shape("ellipsoid:1:0.8:0.6")};
  library.shape[0].name = "egg";
  ::setenv("SCREE_CACHE", folder_.c_str(), 1);
  BakeRequest const request{ShapeKind::grid, 8, 1};
  std::vector<std::string> notes;
  auto const bake = [&] { return cached_bake(library, library.shape[0], request, notes).grid.at(0)->value; };
  std::vector<float> const good = bake();
  fs::path const file = folder_ / (bake_key(library, library.shape[0], request) + ".h5");
  std::string const bytes = read_file(file);
  for (std::size_t length = 0; length < bytes.size(); length += bytes.size() / 7) {
    write_file(file, bytes.substr(0, length));
    EXPECT_EQ(bake(), good);
    EXPECT_EQ(read_file(file).size(), bytes.size());
  }
  write_file(folder_ / "payload", bytes);
  seal_container(folder_ / "payload", file, "scree.model", 9);
  EXPECT_EQ(bake(), good);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find(file.string()), std::string::npos) << notes[0];
  {
    FileSizeLimit const limit(600);
    fs::remove(file);
    EXPECT_EQ(bake(), good);
  }
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[1].find("are not kept: " + folder_.string() + " cannot be written"), std::string::npos) << notes[1];
  EXPECT_FALSE(fs::exists(file));
  ::unsetenv("SCREE_CACHE");
}

// As a user meets them: a case that names a cut file is refused with its name, and nothing is written.
TEST_F(DamagedFiles, CasesThatNameThem) {
  Library library;
  library.shape = {builtin_shape("sphere")};
  library.shape[0].name = "ball";
  write_model(folder_ / "lib.h5", library);
  write_mesh(folder_ / "grain.stl", l_prism());
  write_file(folder_ / "hill.asc", terrain);
  write_file(folder_ / "poses.csv", "x,y,z\n0,0,1\n0,0,2.25\n");
  std::string const head =
      "[time]\nend = 1e-3\nstep = 1e-5\n[[material]]\nname = \"rock\"\ndensity = 2650\n[[contact]]\n"
      "pair = [\"rock\", \"rock\"]\nnormal = { stiffness = 2e5 }\n";
  auto const grains = [](std::string const& shape, std::string const& insert) {
    return "[[grains]]\nname = \"g\"\nmaterial = \"rock\"\nshapes = [\"" + shape +
           "\"]\ndiameter = 0.1\nnodes = 100\ninsert = " + insert + "\n";
  };
  std::string const place = "{ kind = \"list\", position = [[0, 0, 9]] }";
  std::map<std::string, std::string> const cases{
      {"lib.h5", head + "[[library]]\nname = \"lib\"\nfile = \"lib.h5\"\n" + grains("lib:ball", place)},
      {"grain.stl", head + grains("mesh:grain.stl", place)},
      {"hill.asc", head + grains("sphere", place) +
                       "[[wall]]\nname = \"hill\"\nkind = \"terrain\"\nfile = \"hill.asc\"\nmaterial = \"rock\"\n"},
      {"poses.csv", head + grains("sphere", "{ kind = \"file\", file = \"poses.csv\" }")}};
  for (auto const& [name, text] : cases) {
    SCOPED_TRACE(name);
    write_file(folder_ / "c.toml", text);
    Outcome const good = shell(folder_, SCREE_PROGRAM " run c.toml --force -o good");
    ASSERT_EQ(good.code, 0) << good.text;
    std::string const bytes = read_file(folder_ / name);
    for (std::size_t const length : {std::size_t{0}, bytes.size() / 2}) {
      write_file(folder_ / name, bytes.substr(0, length));
      Outcome const cut = shell(folder_, SCREE_PROGRAM " run c.toml -o bad");
      EXPECT_EQ(cut.code, 2) << cut.text;
      EXPECT_NE(cut.text.find(name), std::string::npos) << cut.text;
      EXPECT_FALSE(fs::exists(folder_ / "bad"));
    }
    write_file(folder_ / name, bytes);
  }
}

// An unfinished results file has no CRC: --recover reads it or says why not, at every length at which a kill left it.
TEST_F(DamagedFiles, TornResultsAreRecoveredOrRefused) {
  write_file(
      folder_ / "c.toml",
      "[time]\nend = 4e-3\nstep = 1e-5\n[[material]]\nname = \"rock\"\ndensity = 2650\n[[contact]]\npair = [\"rock\", "
      "\"rock\"]\nnormal = { stiffness = 2e5 }\n[[grains]]\nname = \"g\"\nmaterial = \"rock\"\nshapes = [\"sphere\"]\n"
      "evaluator = \"analytic\"\ndiameter = 0.1\ninsert = { kind = \"list\", position = [[0, 0, 9]] }\n[output]\nevery "
      "= 1e-4\n");
  ASSERT_EQ(shell(folder_, SCREE_PROGRAM " run c.toml -o out").code, 0);
  std::string const bytes = read_file(folder_ / "out/results.h5");
  int refused = 0;
  for (int k = 0; k < 24; ++k) {
    write_file(folder_ / "torn.h5.partial", bytes.substr(0, bytes.size() * k / 24));
    Outcome const torn = shell(folder_, SCREE_PROGRAM " info torn.h5 --recover");
    EXPECT_TRUE(torn.code == 0 || torn.code == 2) << torn.code << torn.text;  // no signal
    refused += torn.code == 2;
    if (torn.code == 2) {
      EXPECT_NE(torn.text.find("torn.h5"), std::string::npos) << torn.text;
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace scree
