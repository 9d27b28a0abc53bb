// test_ply.cpp: PLY meshes and point clouds (PLY, XYZ) in and out, variants of the format, malformed files.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "shapes/mesh_files.h"
#include "shapes/point_files.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertex = {{0.1, 0, 0}, {1, 1e-17, 0}, {0, 1, 0}, {0, 0, 1.0 / 3}};
  mesh.triangle = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

class Ply : public testing::Test {
 protected:
  Ply() {
    folder = fs::temp_directory_path() / ("scree_ply_" + std::to_string(::getpid()));
    fs::create_directories(folder);
  }
  ~Ply() override { fs::remove_all(folder); }

  fs::path put(std::string const& name, std::string const& content) {
    std::ofstream(folder / name, std::ios::binary) << content;
    return folder / name;
  }
  std::string content(fs::path const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  template <class Read>
  std::string complaint(Read const& read) {
    try {
      read();
    } catch (std::runtime_error const& e) {
      return e.what();
    }
    return "";
  }
  fs::path folder;
};

std::string const ascii =  // a square as one polygon, with what other programs add
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nelement material 1\nproperty list uchar float ambient\nelement face 1\n"
    "property list uchar int vertex_index\nproperty int flags\nelement edge 0\nproperty int vertex1\nend_header\n";
std::string const rows = "0 0 0 255\n1 0 0 255\n1 1 0 0\n0 1 0 0\n2 0.5 0.5\n";

TEST_F(Ply, MeshKeepsEveryBit) {
  TriangleMesh const mesh = tetrahedron();
  write_mesh(folder / "A.PLY", mesh);
  TriangleMesh const back = read_mesh(folder / "A.PLY");
  ASSERT_EQ(back.vertex.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(back.vertex[i] == mesh.vertex[i]);
  EXPECT_EQ(back.triangle, mesh.triangle);
  EXPECT_FALSE(holds_points(folder / "A.PLY"));
}

TEST_F(Ply, AsciiWithOtherElementsAndPolygons) {
  TriangleMesh const mesh = read_mesh(put("square.ply", ascii + rows + "4 0 1 2 3 7\n\n"));
  EXPECT_EQ(mesh.vertex.size(), 4u);
  ASSERT_EQ(mesh.triangle.size(), 2u);
  EXPECT_EQ(mesh.triangle[1], (std::array<int, 3>{0, 2, 3}));
  std::string dos;
  for (char c : ascii + rows + "4 0 1 2 3 7\n") dos += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read_mesh(put("dos.ply", dos)).triangle.size(), 2u);
}

TEST_F(Ply, BinaryOfOtherTypes) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty short x\nproperty uchar y\nproperty int z\n"
      "property list ushort double extra\nelement face 1\nproperty list int uchar vertex_indices\nend_header\n";
  auto const append = [&](auto value) { bytes.append(reinterpret_cast<char const*>(&value), sizeof(value)); };
  for (int i = 0; i < 3; ++i) {
    append(static_cast<std::int16_t>(-300 * i));
    append(static_cast<std::uint8_t>(200 + i));
    append(std::int32_t{i * i * 70000});
    append(static_cast<std::uint16_t>(i));  // lists of 0, 1 and 2 numbers to be skipped
    for (int k = 0; k < i; ++k) append(1.5);
  }
  append(std::int32_t{3});
  for (std::uint8_t v : {0, 1, 2}) append(v);
  TriangleMesh const mesh = read_mesh(put("types.ply", bytes));
  EXPECT_TRUE(mesh.vertex[2] == (Vec3{-600, 202, 280000}));
  EXPECT_EQ(mesh.triangle.size(), 1u);
}

TEST_F(Ply, PointCloudsRoundTrip) {
  PointCloud cloud{{{0.1, 2, -3}, {1.0 / 3, 0, 1e9}}, {{0, 0, 1}, {0.6, 0, -0.8}}};
  for (bool normals : {true, false}) {
    if (!normals) cloud.normal.clear();
    for (char const* name : {"p.ply", "p.xyz"}) {
      write_points(folder / name, cloud);
      PointCloud const back = read_points(folder / name);
      ASSERT_EQ(back.position.size(), 2u);
      ASSERT_EQ(back.normal.size(), cloud.normal.size());
      for (int i = 0; i < 2; ++i) EXPECT_TRUE(back.position[i] == cloud.position[i]) << name;
      for (std::size_t i = 0; i < cloud.normal.size(); ++i)
        EXPECT_NEAR(norm(back.normal[i] - cloud.normal[i]), 0, 1e-7);  // float in PLY
      EXPECT_TRUE(holds_points(folder / name));
    }
  }
  write_mesh(folder / "mesh.ply", tetrahedron());
  EXPECT_EQ(read_points(folder / "mesh.ply").position.size(), 4u);  // a mesh's vertices are points too
  EXPECT_EQ(read_points(put("c.xyz", "# x y z\n\n1 2 3 # first\n4 5 6\n")).position.size(), 2u);
}

TEST_F(Ply, MalformedFilesAreNamedWithTheirPlace) {
  write_mesh(folder / "good.ply", tetrahedron());
  std::string const good = content(folder / "good.ply");
  std::size_t const body = good.find("end_header\n") + 11;
  auto const patched = [&](std::size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    return bytes;
  };
  auto const header = [](std::string const& lines) { return "ply\nformat ascii 1.0\n" + lines + "end_header\n"; };
  std::string const xyz = "property float x\nproperty float y\nproperty float z\n";
  std::size_t const faces = body + 4 * 24;
  struct Case {
    fs::path file;
    char const* expected;
  };
  Case const cases[] = {
      {put("empty.ply", ""), ":1: the PLY header has no end_header"},
      {put("magic.ply", "plx\n"), ":1: a PLY file begins with: ply"},
      {put("big.ply", "ply\nformat binary_big_endian 1.0\nend_header\n"), ":2: binary_big_endian is not read"},
      {put("version.ply", "ply\nformat ascii 2.0\nend_header\n"), ":2: write: format FORMAT 1.0"},
      {put("noformat.ply", "ply\nelement vertex 0\nend_header\n"), ":3: the PLY header names no format"},
      {put("type.ply", header("element vertex 1\nproperty half x\n")), ":4: unknown PLY type: half"},
      {put("minus.ply", header("element vertex -1\n")), ":3: not a count between 0 and 2^28: -1"},
      {put("listlength.ply", header("element face 1\nproperty list float int vertex_indices\n")),
       ":4: the length of a list must be an integer"},
      {put("orphan.ply", header("property float x\n")), ":3: a property before the first element"},
      {put("word.ply", header("elephant vertex 1\n")), ":3: unknown word in the PLY header: elephant"},
      {put("novertex.ply", header("element face 0\nproperty list uchar int vertex_indices\n")), "no element 'vertex'"},
      {put("flat.ply", header("element vertex 1\nproperty float x\nproperty float y\n") + "0 0\n"),
       "needs the numbers x, y and z"},
      {put("listx.ply",
           header("element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n") + "1 0 0 0\n"),
       "needs the numbers x, y and z"},
      {put("points.ply", header("element vertex 1\n" + xyz) + "0 0 0\n"), "has no triangles"},
      {put("scalarface.ply",
           header("element vertex 1\n" + xyz + "element face 1\nproperty int vertex_indices\n") + "0 0 0\n0\n"),
       "needs a list of integers vertex_indices"},
      {put("floatface.ply",
           header("element vertex 1\n" + xyz + "element face 1\nproperty list uchar float vertex_indices\n") +
               "0 0 0\n3 0 0 0\n"),
       "needs a list of integers vertex_indices"},
      {put("fewrows.ply", ascii + "0 0 0 255\n1 0 0 255\n"), ":19: the file ends before vertex 2 of 4"},
      {put("noface.ply", ascii + rows), ":22: the file ends before face 0 of 1"},
      {put("manyrows.ply", ascii + rows + "4 0 1 2 3 7\n3 0 1 2 7\n"), ":24: more rows than the header promises"},
      {put("short.ply", ascii + "0 0\n"), ":18: too few values for a vertex"},
      {put("long.ply", ascii + "0 0 0 0 0\n"), ":18: too many values for a vertex"},
      {put("nan.ply", ascii + "0 nan 0 0\n"), ":18: not a finite number: nan"},
      {put("letters.ply", ascii + "0 x 0 0\n"), ":18: not a finite number: x"},
      {put("fraction.ply", ascii + rows + "3 0 1 1.5 0\n"), ":23: not an integer: 1.5"},
      {put("range.ply", ascii + rows + "3 0 1 4 0\n"), ":23: vertex 4 does not exist (there are 4, from 0)"},
      {put("negative.ply", ascii + rows + "3 0 -1 2 0\n"), ":23: vertex -1 does not exist"},
      {put("edge.ply", ascii + rows + "2 0 1 0\n"), ":23: a face needs three corners"},
      {put("endless.ply", ascii + rows + "100000 0 1 0\n"), ":23: a list of 100000 items does not fit the file"},
      {put("cut.ply", good.substr(0, good.size() - 1)), "face 3: the file is cut short"},
      {put("cutvertex.ply", good.substr(0, body + 30)), "vertex 1: the file is cut short"},
      {put("more.ply", good + "x"), "1 bytes more than the header promises"},
      {put("binarynan.ply", patched(body + 24, std::numeric_limits<double>::quiet_NaN())),
       "vertex 1: a coordinate is not finite"},
      {put("binaryrange.ply", patched(faces + 13 + 1, std::int32_t{4})), "face 1: vertex 4 does not exist"},
      {put("binarylength.ply", patched(faces, std::uint8_t{2})), "face 0: a face needs three corners"},
  };
  for (Case const& c : cases) {
    std::string const found = complaint([&] { read_mesh(c.file); });
    EXPECT_NE(found.find(c.expected), std::string::npos) << c.file << ": " << found;
    EXPECT_EQ(found.rfind(c.file.string(), 0), 0u) << found;
  }
}

TEST_F(Ply, MalformedPointsAreNamedWithTheirLine) {
  struct Case {
    fs::path file;
    char const* expected;
  };
  Case const cases[] = {
      {put("four.xyz", "0 0 0 1\n"), ":1: 4 words"},
      {put("mixed.xyz", "0 0 0\n0 0 0 0 0 1\n"), ":2: 6 words"},
      {put("colour.xyz", "0 0 0 255 0 0\n"), ":1: columns 4 to 6 must be a unit normal"},
      {put("nan.xyz", "0 0 0\n0 nan 0\n"), ":2: not a finite number: nan"},
      {put("empty.xyz", "# nothing\n"), "has no points"},
      {put("mesh.stl", "solid x\n"), "unknown point format"},
      {folder / "missing.xyz", "no such file"},
  };
  for (Case const& c : cases) {
    std::string const found = complaint([&] { read_points(c.file); });
    EXPECT_NE(found.find(c.expected), std::string::npos) << c.file << ": " << found;
  }
  EXPECT_THROW(write_points(folder / "a.stl", {{{0, 0, 0}}, {}}), std::runtime_error);
  EXPECT_THROW(write_points(folder / "none" / "a.xyz", {{{0, 0, 0}}, {}}), std::runtime_error);
}

}  // namespace
}  // namespace scree
