// paraview_test.cpp: the ParaView export, decoded here and read back by VTK's own reader where that is installed.
// SPDX-License-Identifier: Apache-2.0
#include "core/paraview.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>

#include "core/grain_mesh.h"
#include "core/vtk_file.h"
#include "core/wall_surface.h"
#include "shapes/analytic_shapes.h"

namespace {

using namespace scree;
namespace fs = std::filesystem;

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The bytes of one appended array of a VTP file, by the format's definition: the first of that name after `section`.
std::vector<char> decode(fs::path const& file, std::string const& name, std::string const& section) {
  std::string const text = read_file(file);
  std::size_t const at = text.find("Name=\"" + name + "\"", text.find("<" + section + ">"));
  std::size_t const offset_at = text.find("offset=\"", at) + 8;
  std::size_t const start = text.find('_', text.find("<AppendedData")) + 1 + std::stoul(text.substr(offset_at));
  auto const word = [&](std::size_t i) {
    std::uint64_t value = 0;
    std::memcpy(&value, text.data() + start + 8 * i, 8);
    return value;
  };
  std::uint64_t const blocks = word(0), size = word(1), last = word(2);
  std::vector<char> out;
  std::size_t from = start + 8 * (3 + blocks);
  for (std::uint64_t b = 0; b < blocks; ++b) {
    uLongf count = b + 1 == blocks && last ? last : size;
    std::vector<char> block(count);
    EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(block.data()), &count,
                           reinterpret_cast<Bytef const*>(text.data() + from), word(3 + b)),
              Z_OK);
    from += word(3 + b);
    out.insert(out.end(), block.begin(), block.end());
  }
  return out;
}

template <class T>
std::vector<T> decode_as(fs::path const& file, std::string const& name, std::string const& section = "PointData") {
  std::vector<char> const bytes = decode(file, name, section);
  std::vector<T> out(bytes.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());  // a file of no points is nothing to copy
  return out;
}

int occurrences(std::string const& text, std::string const& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// Two grains in a 1 m box without a lid.
ResultsHeader two_grains() {
  ResultsHeader h;
  for (char const* word : {"sphere", "box:1:1:2"}) {
    h.library.shape.push_back(builtin_shape(word));
    h.shape_name.push_back(word);
  }
  h.shape = {1, 0};
  h.diameter = {0.2, 0.4};
  h.material = h.group = h.replica = {0, 0};
  h.wall = {{"floor", {0, 0, 0}, {0, 0, 1}}, {"left", {0, 0, 0}, {1, 0, 0}}};
  h.domain = {{0, 0, 0}, {1, 1, 1}};
  return h;
}

Frame two_poses(double height) {
  Frame f;
  f.time = height;
  f.position = {{0.25, 0.5, height}, {0.75, 0.5, 0.5}};
  f.orientation = {quat_from_rotation_vector({1.5707963267948966, 0, 0}), Quat{}};  // the box's long axis z onto -y
  f.velocity = {{0, 0, -1}, {0, 0, 0}};
  f.spin = {{0, 0, 0}, {0, 0, 3}};
  return f;
}

class ParaviewExport : public testing::Test {
 protected:
  void SetUp() override { folder_ = fs::temp_directory_path() / ("scree_paraview_test_" + std::to_string(::getpid())); }
  void TearDown() override { fs::remove_all(folder_); }
  // `frames` frames; a budget for surfaces in `surfaces` of them.
  void write(int frames, int surfaces) {
    ParaviewOptions options;
    options.frames_expected = frames;
    options.surface_budget = 1e3 * surfaces;  // one frame of these two grains takes 93 kB
    if (surfaces == frames) options.surface_budget = 1e9;
    ParaviewWriter writer(folder_, two_grains(), options);
    for (int k = 0; k < frames; ++k) writer.write_frame(two_poses(0.3 + 0.01 * k));
    writer.finish();
  }
  fs::path folder_;
};

TEST(LightMesh, SphereLiesOnItsSurface) {
  Library library;
  library.shape.push_back(make_sphere());
  TriangleMesh const mesh = light_mesh(library, library.shape[0], 600);
  EXPECT_EQ(mesh.triangle.size(), 500u);                              // 20 n^2 at n = 5
  EXPECT_EQ(mesh.vertex.size(), 252u);                                // 10 n^2 + 2
  for (Vec3 const& v : mesh.vertex) EXPECT_NEAR(norm(v), 0.5, 1e-8);  // 20 halvings of 0.55/64
  MeshMass const mass = mesh_mass(mesh);
  // Positive: seen from outside counter-clockwise. An inscribed polyhedron of 500 faces lacks a few percent.
  EXPECT_LT(mass.volume, library.shape[0].volume);
  EXPECT_GT(mass.volume, 0.96 * library.shape[0].volume);
}

TEST(LightMesh, ShapeThatIsNotStarShapedFallsBackToTheZeroSet) {
  // phi of a network with one sine neuron: two slabs, so that rays cross it several times.
  Library library;
  Mlp net;
  net.activation = Activation::sine;
  net.parameter = 1;
  net.width = {3, 8, 1};
  net.weight = {std::vector<float>(24, 0.0f), std::vector<float>(8, 0.0f)};
  net.bias = {std::vector<float>(8, 0.0f), {-0.1f}};
  net.weight[0][0] = 20;  // sin(20 x)
  net.weight[1][0] = 0.2f;
  library.net.push_back(net);
  Shape s = make_sphere();
  s.kind = ShapeKind::net;
  s.net = 0;
  s.lipschitz = 5;
  library.shape.push_back(s);
  TriangleMesh const mesh = light_mesh(library, library.shape[0], 600);
  EXPECT_GT(mesh.triangle.size(), 600u);
}

TEST_F(ParaviewExport, SurfacesStandWhereTheGrainsAre) {
  write(2, 2);
  fs::path const file = folder_ / "frames/surfaces_00001.vtp";
  auto const point = decode_as<float>(file, "Points");
  auto const body = decode_as<std::int32_t>(file, "body");
  auto const connectivity = decode_as<std::int32_t>(file, "connectivity", "Polys");
  ASSERT_EQ(connectivity.size(), 3 * body.size());
  std::map<int, Box> box;
  for (std::size_t cell = 0; cell < body.size(); ++cell)
    for (int corner = 0; corner < 3; ++corner) {
      float const* const x =
          &point.at(3 * static_cast<std::size_t>(connectivity[3 * cell + static_cast<std::size_t>(corner)]));
      auto const [entry, first] = box.try_emplace(body[cell], Box{{1e9, 1e9, 1e9}, {-1e9, -1e9, -1e9}});
      for (int axis = 0; axis < 3; ++axis) {
        entry->second.min[axis] = std::min<double>(entry->second.min[axis], x[axis]);
        entry->second.max[axis] = std::max<double>(entry->second.max[axis], x[axis]);
      }
    }
  ASSERT_EQ(box.size(), 2u);
  // The sphere of 0.4 m at (0.75, 0.5, 0.5); a geodesic vertex is at most 0.3 rad off an axis: 1 - cos 0.3 = 4.5 %.
  EXPECT_NEAR(box[1].max.z, 0.7, 0.045 * 0.2);
  EXPECT_NEAR(box[1].min.x, 0.55, 0.045 * 0.2);
  // The box's long side lies along y now; its corners are between rays: only the order of lengths is sharp.
  Vec3 const size = box[0].max - box[0].min;
  EXPECT_GT(size.y, 1.5 * size.z);
  EXPECT_GT(size.y, 1.5 * size.x);
  EXPECT_NEAR((box[0].min.z + box[0].max.z) / 2, 0.31, 0.01);
}

TEST_F(ParaviewExport, PointsCarryTheState) {
  write(1, 1);
  fs::path const file = folder_ / "frames/grains_00000.vtp";
  EXPECT_EQ(decode_as<double>(file, "diameter"), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(decode_as<double>(file, "position"), (std::vector<double>{0.25, 0.5, 0.3, 0.75, 0.5, 0.5}));
  EXPECT_EQ(decode_as<double>(file, "spin"), (std::vector<double>{0, 0, 0, 0, 0, 3}));
  EXPECT_EQ(decode_as<float>(file, "velocity"), (std::vector<float>{0, 0, -1, 0, 0, 0}));
  EXPECT_EQ(decode_as<std::int32_t>(file, "kind"), (std::vector<std::int32_t>{1, 0}));
}

TEST_F(ParaviewExport, InactiveBodiesAreLeftOut) {
  ParaviewWriter writer(folder_, two_grains(), {});
  Frame frame = two_poses(0.3);
  frame.activity = {Activity::pending, Activity::active};
  writer.write_frame(frame);
  frame.activity = {Activity::deleted, Activity::deleted};
  writer.write_frame(frame);
  writer.finish();
  fs::path const file = folder_ / "frames/grains_00000.vtp";
  EXPECT_EQ(decode_as<std::int32_t>(file, "body"), (std::vector<std::int32_t>{1}));
  EXPECT_EQ(decode_as<double>(file, "diameter"), (std::vector<double>{0.4}));
  EXPECT_EQ(decode_as<double>(file, "position"), (std::vector<double>{0.75, 0.5, 0.5}));
  EXPECT_EQ(decode_as<double>(file, "orientation"), (std::vector<double>{1, 0, 0, 0}));
  for (std::int32_t const body : decode_as<std::int32_t>(folder_ / "frames/surfaces_00000.vtp", "body"))
    ASSERT_EQ(body, 1);
  EXPECT_TRUE(decode_as<std::int32_t>(folder_ / "frames/surfaces_00001.vtp", "body").empty());
}

TEST_F(ParaviewExport, SurfacesAreThinnedToTheBudgetButTheLastFrameHasThem) {
  write(10, 3);
  std::string const scene = read_file(folder_ / "scene.pvd"), grains = read_file(folder_ / "grains.pvd");
  EXPECT_EQ(occurrences(grains, "<DataSet"), 10);
  EXPECT_LT(occurrences(scene, "surfaces_"), 10);
  EXPECT_NE(scene.find("surfaces_00000.vtp"), std::string::npos);
  EXPECT_NE(scene.find("surfaces_00009.vtp"), std::string::npos);
  EXPECT_EQ(occurrences(scene, "walls.vtp"), occurrences(scene, "surfaces_"));
}

TEST_F(ParaviewExport, WallsAreTheirPartOfTheDomain) {
  write(1, 1);
  auto const point = decode_as<float>(folder_ / "walls.vtp", "Points");
  ASSERT_EQ(point.size(), 2u * 4 * 3);  // two unit squares
  for (int corner = 0; corner < 4; ++corner) {
    EXPECT_NEAR(point[3 * corner + 2], 0, 1e-6);       // the floor
    EXPECT_NEAR(point[12 + 3 * corner + 0], 0, 1e-6);  // the left wall
  }
}

// A block at rest and a disc that rises, behind the two planes.
ResultsHeader with_wall_bodies() {
  ResultsHeader h = two_grains();
  ResultsWallBody block;
  block.kind = WallSolidKind::box;
  block.formula.kind = AnalyticKind::box;
  block.formula.half_size = {0.125, 0.25, 0.5};
  block.position = {2, 0, 0};
  block.orientation = quat_from_rotation_vector({0, 0, 1.5707963267948966});
  ResultsWallBody disc;
  disc.moving = true;
  disc.formula.kind = AnalyticKind::plane;
  disc.mesh = fan(circle(0.5));
  h.wall_body = {block, disc};
  return h;
}

std::string read_by_vtk(fs::path const& folder, int& status) {
  std::string const command =
      std::string("/usr/bin/python3 ") + SCREE_SOURCE_DIR + "/tests/core/paraview_read.py " + folder.string();
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  std::string out;
  std::array<char, 4096> buffer;
  while (std::size_t const n = std::fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), n);
  status = WEXITSTATUS(::pclose(pipe));
  return out;
}

TEST_F(ParaviewExport, WallBodiesAtRestAreWrittenOnceAndMovingOnesForEachFrame) {
  ParaviewWriter writer(folder_, with_wall_bodies(), {});
  for (int k = 0; k < 2; ++k) {
    Frame f = two_poses(0.3 + 0.01 * k);
    f.wall_position = {{0, 0, 0.25 * k}};
    f.wall_orientation = {{}};
    writer.write_frame(f);
  }
  writer.finish();
  auto const wall = decode_as<std::int32_t>(folder_ / "walls.vtp", "wall", "CellData");
  ASSERT_EQ(wall.size(), 2u + 12);  // two polygons, then the block's triangles
  EXPECT_EQ(wall[1], 1);
  EXPECT_EQ(wall[2], 2);
  EXPECT_EQ(wall.back(), 2);
  auto const point = decode_as<float>(folder_ / "walls.vtp", "Points");
  ASSERT_EQ(point.size(), 3u * (2 * 4 + 8));
  for (std::size_t i = 8; i < 16; ++i) {  // turned by 90 degrees: its sides along x and y change places
    EXPECT_NEAR(std::fabs(point[3 * i] - 2), 0.25, 1e-6);
    EXPECT_NEAR(std::fabs(point[3 * i + 1]), 0.125, 1e-6);
    EXPECT_NEAR(std::fabs(point[3 * i + 2]), 0.5, 1e-6);
  }
  auto const lid = decode_as<float>(folder_ / "frames/walls_00001.vtp", "Points");
  ASSERT_EQ(lid.size(), 3u * circle_segments);
  for (int i = 0; i < circle_segments; ++i) EXPECT_NEAR(lid[3 * i + 2], 0.25, 1e-6);
  EXPECT_EQ(decode_as<std::int32_t>(folder_ / "frames/walls_00000.vtp", "wall", "CellData"),
            std::vector<std::int32_t>(circle_segments - 2, 3));
  int status = 0;
  std::string const out = read_by_vtk(folder_, status);
  if (status == 77 || status == 127) GTEST_SKIP() << "VTK for Python is not installed (Debian: python3-vtk9)";
  ASSERT_EQ(status, 0) << out;
  EXPECT_EQ(occurrences(out, "walls.vtp points 16 cells 14"), 2) << out;
  EXPECT_NE(out.find("frames/walls_00001.vtp points 128 cells 126 bounds -0.5000 0.5000 -0.5000 0.5000 0.2500 0.2500"),
            std::string::npos)
      << out;
}

TEST_F(ParaviewExport, VtkReadsEveryFile) {
  write(3, 3);
  EXPECT_EQ(occurrences(read_file(folder_ / "scene.pvd"), "frames/walls_"), 0);
  int status = 0;
  std::string const out = read_by_vtk(folder_, status);
  if (status == 77 || status == 127) GTEST_SKIP() << "VTK for Python is not installed (Debian: python3-vtk9)";
  ASSERT_EQ(status, 0) << out;
  EXPECT_EQ(occurrences(out, "surfaces_"), 3);
  EXPECT_EQ(occurrences(out, "walls.vtp points 8 cells 2"), 3) << out;
  EXPECT_EQ(occurrences(out, "grains.pvd"), 3);
  EXPECT_NE(out.find("points 2 cells 2 bounds 0.2500 0.7500 0.5000 0.5000 0.3200 0.5000"), std::string::npos) << out;
  EXPECT_NE(out.find("arrays body diameter group kind material orientation position replica shape spin velocity"),
            std::string::npos)
      << out;
}

}  // namespace
