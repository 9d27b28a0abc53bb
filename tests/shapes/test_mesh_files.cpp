// test_mesh_files.cpp: STL and OBJ in and out (PLY: test_ply.cpp), malformed files, and mass properties of polyhedra.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "shapes/mesh_files.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Box [0, size] moved by `at`, 8 vertices, 12 triangles.
TriangleMesh box_mesh(Vec3 size, Vec3 at = {}) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertex.push_back(at + Vec3{(i & 1) * size.x, ((i >> 1) & 1) * size.y, ((i >> 2) & 1) * size.z});
  mesh.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

class MeshFiles : public testing::Test {
 protected:
  MeshFiles() {
    folder = fs::temp_directory_path() / ("scree_mesh_" + std::to_string(::getpid()));
    fs::create_directories(folder);
  }
  ~MeshFiles() override { fs::remove_all(folder); }

  fs::path put(std::string const& name, std::string const& content) {
    std::ofstream(folder / name, std::ios::binary) << content;
    return folder / name;
  }
  std::string complaint(fs::path const& file) {
    try {
      read_mesh(file);
    } catch (std::runtime_error const& e) {
      return e.what();
    }
    return "";
  }
  fs::path folder;
};

TEST(MeshMass, BoxAwayFromTheOrigin) {
  Vec3 const size{1, 0.5, 0.25}, at{100, -50, 30};
  MeshMass const m = mesh_mass(box_mesh(size, at));
  double const v = size.x * size.y * size.z;
  // The mesh is stored 100 sizes away: 1e-14 of rounding in the coordinates themselves, times a few hundred terms.
  EXPECT_NEAR(m.volume, v, 1e-13);
  EXPECT_NEAR(m.area, 2 * (size.x * size.y + size.y * size.z + size.z * size.x), 1e-12);
  EXPECT_NEAR(norm(m.centroid - (at + size * 0.5)), 0, 1e-12);
  EXPECT_NEAR(m.inertia.row[0].x, v / 12 * (size.y * size.y + size.z * size.z), 1e-13);
  EXPECT_NEAR(m.inertia.row[2].z, v / 12 * (size.x * size.x + size.y * size.y), 1e-13);
  EXPECT_NEAR(m.inertia.row[0].y, 0, 1e-13);
}

TEST(MeshMass, TetrahedronHasItsProducts) {
  TriangleMesh mesh;
  mesh.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangle = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  MeshMass const m = mesh_mass(mesh);
  EXPECT_NEAR(m.volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR(norm(m.centroid - Vec3{0.25, 0.25, 0.25}), 0, 1e-15);
  // Integral of x^2 is 1/60, of xy 1/120; minus V c^2 = 1/96.
  EXPECT_NEAR(m.inertia.row[0].x, 2 * (1.0 / 60 - 1.0 / 96), 1e-15);
  EXPECT_NEAR(m.inertia.row[0].y, -(1.0 / 120 - 1.0 / 96), 1e-15);
}

TEST_F(MeshFiles, StlAndObjRoundTrip) {
  TriangleMesh const box = box_mesh({1, 0.5, 0.25}, {0.1, 0, 0});
  for (char const* name : {"a.stl", "A.OBJ"}) {
    write_mesh(folder / name, box);
    TriangleMesh const back = read_mesh(folder / name);
    EXPECT_EQ(back.vertex.size(), 8u) << name;  // welded
    EXPECT_EQ(back.triangle.size(), 12u);
    EXPECT_NEAR(mesh_mass(back).volume, 0.125, 1e-7);  // STL keeps floats
  }
  TriangleMesh const exact = read_mesh(folder / "A.OBJ");
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(exact.vertex[i] == box.vertex[i]);  // OBJ keeps every bit
  EXPECT_THROW(write_mesh(folder / "none" / "a.stl", box), std::runtime_error);
  EXPECT_THROW(write_mesh(folder / "a.off", box), std::runtime_error);
}

TEST_F(MeshFiles, AsciiStlAndObjVariants) {
  std::string const facet =
      "  facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1e0 0\n endloop\n endfacet\n";
  TriangleMesh const stl = read_mesh(put("a.stl", "solid x\r\n" + facet + facet + "endsolid x\n"));
  EXPECT_EQ(stl.vertex.size(), 3u);
  EXPECT_EQ(stl.triangle.size(), 2u);
  TriangleMesh const obj = read_mesh(put(
      "a.obj",
      "# quad\no thing\nv 0 0 0\nv 1 0 0 # corner\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -4 -3/1 -2\n"));
  EXPECT_EQ(obj.triangle.size(), 3u);
}

TEST_F(MeshFiles, MalformedFilesAreNamedWithTheirLine) {
  write_mesh(folder / "good.stl", box_mesh({1, 1, 1}));
  std::ifstream in(folder / "good.stl", std::ios::binary);
  std::string const good((std::istreambuf_iterator<char>(in)), {});
  std::string lying = good, nan = good;
  lying[80] = 13;
  float const bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data() + 84 + 50 * 5 + 12, &bad, 4);
  struct Case {
    fs::path file;
    char const* expected;
  };
  Case const cases[] = {
      {put("short.stl", good.substr(0, good.size() - 1)), "promises 12 facets"},
      {put("lying.stl", lying), "promises 13 facets"},
      {put("nan.stl", nan), "facet 5: a coordinate is not finite"},
      {put("tiny.stl", "abc"), "too short"},
      {put("empty.stl", ""), "too short"},
      {put("none.stl", "solid x\nendsolid x\n"), "has no triangles"},
      {put("two.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\n"),
       ":7: a facet with 2 corners"},
      {put("open.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"), ":4: the file ends inside"},
      {put("word.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n"), ":4: not a finite number: zero"},
      {put("inf.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 inf 0\n"), ":4: not a finite number: inf"},
      {put("range.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"), ":3: vertex 3 does not exist"},
      {put("zero.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n"), ":4: vertex 0 does not exist"},
      {put("negative.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -4 1 2\n"), ":4: vertex -4 does not exist"},
      {put("letters.obj", "v 0 0 0\nf a b c\n"), ":2: not a vertex index: a"},
      {put("face.obj", "v 0 0 0\nf 1 1\n"), ":2: a face needs three corners"},
      {put("coordinate.obj", "v 0 0\n"), ":1: a vertex needs three coordinates"},
      {put("mesh.off", "OFF\n"), "unknown mesh format"},
      {folder / "missing.obj", "no such file"},
  };
  for (Case const& c : cases) {
    std::string const found = complaint(c.file);
    EXPECT_NE(found.find(c.expected), std::string::npos) << c.file << ": " << found;
    EXPECT_EQ(found.rfind(c.file.string(), 0), 0u) << found;
  }
}

}  // namespace
}  // namespace scree
