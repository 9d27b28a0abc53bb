// test_shape_cli.cpp: scree-shape reconstruct and points as a user meets them: the triangle mesh, phi, points; wrong
// input.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/point_files.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

class ShapeProgram : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_shape_cli_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    fs::create_symlink(fs::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5", folder_ / "grains.h5");
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Exit code; what the program said, both streams, is in said_.
  int run(std::string const& arguments) {
    std::string const command = "cd '" + folder_.string() + "' && '" SCREE_SHAPE "' " + arguments + " > said.txt 2>&1";
    int const status = std::system(command.c_str());
    std::ostringstream text;
    text << std::ifstream(folder_ / "said.txt").rdbuf();
    said_ = text.str();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // `arguments` must fail with `code`, say `part`, and write no file out.*.
  void refused(std::string const& arguments, int code, std::string const& part) {
    EXPECT_EQ(run(arguments), code) << arguments << "\n" << said_;
    EXPECT_NE(said_.find(part), std::string::npos) << arguments << "\n" << said_;
    for (char const* name : {"out.stl", "out.ply", "out.xyz"}) EXPECT_FALSE(fs::exists(folder_ / name)) << arguments;
  }
  bool says(std::string const& text) const { return said_.find(text) != std::string::npos; }

  fs::path folder_;
  std::string said_;
};

TEST_F(ShapeProgram, GoesRoundTheTriangle) {
  // phi -> points -> mesh
  ASSERT_EQ(run("points grains.h5 --shape sand/4 --count 1500 -o points.ply"), 0) << said_;
  EXPECT_TRUE(says("1500 points, ")) << said_;
  EXPECT_EQ(read_points(folder_ / "points.ply").normal.size(), 1500u);
  ASSERT_EQ(run("reconstruct points.ply -o from_points.stl"), 0) << said_;
  EXPECT_TRUE(says("farthest point from the mesh")) << said_;
  // phi -> mesh, every way and format
  double const volume = std::numbers::pi / 6;  // of every shape of a model
  ASSERT_EQ(
      run("reconstruct grains.h5 --shape cobble/2 --method harmonics --points 1000 --samples 500 -o harmonics.ply"), 0)
      << said_;
  ASSERT_EQ(run("reconstruct grains.h5 --shape sand/4 --method marching --cells 20 --samples 500 -o marching.obj"), 0)
      << said_;
  ASSERT_EQ(run("reconstruct grains.h5 --shape sand/4 --points 1500 --samples 500 -o alpha.ply"), 0) << said_;
  EXPECT_TRUE(says("Hausdorff distance")) << said_;
  for (char const* name : {"from_points.stl", "harmonics.ply", "marching.obj", "alpha.ply"}) {
    TriangleMesh const mesh = read_mesh(folder_ / name);
    EXPECT_TRUE(check_mesh(mesh, false).defects.empty()) << name;
    EXPECT_NEAR(mesh_mass(mesh).volume / volume, 1, 0.015) << name;  // chords of 1,000 to 1,500 points
  }
}

TEST_F(ShapeProgram, MeshesKeepTheirPlaceAndSize) {
  TriangleMesh mesh = procedural_grain(GrainKind::ballast, 0).mesh;
  for (Vec3& v : mesh.vertex) v = v * 20 + Vec3{100, -50, 7};
  write_mesh(folder_ / "rock.stl", mesh);
  ASSERT_EQ(run("points rock.stl --count 2000 -o points.xyz"), 0) << said_;
  ASSERT_EQ(run("reconstruct rock.stl --points 1500 --samples 500 -o alpha.stl"), 0) << said_;
  ASSERT_EQ(run("reconstruct points.xyz -o cloud.stl"), 0) << said_;
  MeshMass const truth = mesh_mass(mesh);
  for (char const* name : {"alpha.stl", "cloud.stl"}) {
    MeshMass const mass = mesh_mass(read_mesh(folder_ / name));
    EXPECT_NEAR(mass.volume / truth.volume, 1, 0.02) << name;
    EXPECT_NEAR(norm(mass.centroid - truth.centroid), 0, 0.1) << name;  // 0.005 of its diameter
  }
}

TEST_F(ShapeProgram, HarmonicsBecomeAModelThatIsCertifiedAgainstItsSource) {
  write_mesh(folder_ / "cobble.stl", procedural_grain(GrainKind::cobble, 1).mesh);
  ASSERT_EQ(run("reconstruct cobble.stl --method harmonics --points 1000 --samples 500 -o cobble.h5"), 0) << said_;
  Library const library = read_model(folder_ / "cobble.h5");
  ASSERT_EQ(library.shape.size(), 1u);
  EXPECT_EQ(library.shape[0].name, "cobble");
  EXPECT_EQ(library.shape[0].kind, ShapeKind::harmonics);
  Certificate const& c = library.shape[0].certificate;
  EXPECT_GT(c.hausdorff, 0);
  EXPECT_LT(c.hausdorff, 0.06);  // degree 10: the worst of the shipped grains, shapes/mesh/README.md
  EXPECT_LT(c.volume_error, 0.01);
  EXPECT_EQ(c.components, 1);
  refused("reconstruct cobble.stl --method harmonics -o cobble.h5", 2, "--force");
  refused("reconstruct cobble.stl --method alpha -o out.h5", 2, "with --method harmonics also .h5");
  refused("reconstruct cobble.stl --name a -o out.stl", 2, "--name");
}

TEST_F(ShapeProgram, InspectsAgainstAMeshAndDraws) {
  TriangleMesh mesh = procedural_grain(GrainKind::cobble, 2).mesh;
  for (Vec3& v : mesh.vertex) v = Vec3{v.y, v.z, v.x} * 3 + Vec3{1, 2, 3};
  write_mesh(folder_ / "cobble.stl", mesh);
  ASSERT_EQ(run("inspect grains.h5 --shape cobble/2 --mesh cobble.stl --plot cobble.svg"), 0) << said_;
  EXPECT_TRUE(says("measured now against the mesh")) << said_;
  EXPECT_TRUE(says("the triangles to the interpolated normals")) << said_;
  EXPECT_TRUE(says("cobble.svg: drawn") || says("no picture: Matplotlib was not found")) << said_;
  for (char const* part : {"slices", "outline", "samples"})
    EXPECT_GT(fs::file_size(folder_ / ("cobble-" + std::string(part) + ".csv")), 1000u) << part;
  if (says("drawn")) {
    EXPECT_GT(fs::file_size(folder_ / "cobble.svg"), 10000u);
  }
  EXPECT_FALSE(says("warning")) << said_;
  ASSERT_EQ(run("inspect grains.h5 --shape sand/4 --mesh cobble.stl"), 0) << said_;
  EXPECT_TRUE(says("warning: that is far off")) << said_;
  refused("inspect grains.h5 --shape cobble/2 --plot cobble.svg", 2, "--force");
  refused("inspect grains.h5 --plot out.png", 2, "choose with --shape one of: ballast/0");
  refused("inspect grains.h5 --shape cobble/2 --plot out.pdf", 2, "out.pdf: write a .png or .svg");
  mesh.triangle.pop_back();
  write_mesh(folder_ / "open.stl", mesh);
  refused("inspect grains.h5 --shape cobble/2 --mesh open.stl", 2, "open.stl: ");
}

TEST_F(ShapeProgram, WrongInputGetsOneMessageAndWritesNothing) {
  TriangleMesh mesh = procedural_grain(GrainKind::ballast, 0).mesh;
  write_mesh(folder_ / "closed.stl", mesh);
  mesh.triangle.pop_back();
  write_mesh(folder_ / "open.stl", mesh);
  write_points(folder_ / "flat.xyz", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}});
  std::ofstream(folder_ / "cut.ply") << "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                                        "property float z\nend_header\n0 0 0\n";
  for (std::string const command : {"reconstruct ", "points "}) {
    std::string const out = command == "points " ? " -o out.xyz" : " -o out.stl";
    refused(command + "nowhere.stl" + out, 2, "nowhere.stl: no such file");
    refused(command + "nowhere.h5 --shape a" + out, 2, "nowhere.h5");
    refused(command + "open.stl" + out, 2, "open along 3 edges");
    refused(command + "rock.step" + out, 2, "rock.step: unknown format");
    refused(command + "grains.h5" + out, 2, "several shapes; choose with --shape one of: ballast/0");
    refused(command + "grains.h5 --shape balast/0" + out, 2, "no shape 'balast/0'");
    refused(command + "closed.stl --shape ballast/0" + out, 2, "no model file");
    refused(command + "closed.stl", 2, "--output");
    refused(command + "closed.stl --threads 0" + out, 2, "--threads");
    refused(command + "closed.stl -o out.png", 2, "out.png: write a");
    refused(command + "closed.stl -o nowhere/out" + (command == "points " ? ".ply" : ".stl"), 4, "nowhere");
  }
  refused("reconstruct closed.stl --method voodoo -o out.stl", 2, "voodoo");
  refused("reconstruct cut.ply -o out.stl", 2, "cut.ply:8: the file ends before vertex 1 of 2");
  refused("reconstruct flat.xyz -o out.stl", 2, "not in one plane");
  refused("reconstruct flat.xyz --method marching -o out.stl", 2, "needs phi");
  refused("reconstruct closed.stl --alpha -1 -o out.stl", 2, "--alpha");
  refused("reconstruct closed.stl --alpha 1e-9 --points 300 --samples 500 -o out.stl", 2, "it takes");
  refused("reconstruct grains.h5 --shape sand/4 --method harmonics -o out.stl", 2, "not star-shaped");
  refused("points grains.h5 --shape sand/4 --spread directions -o out.ply", 2, "use --spread area");
  refused("points flat.xyz -o out.ply", 2, "holds points already");
  refused("points closed.stl --count 0 -o out.ply", 2, "--count");

  std::ofstream(folder_ / "mine.stl") << "mine";
  EXPECT_EQ(run("reconstruct closed.stl --points 300 --samples 500 -o mine.stl"), 2);
  EXPECT_TRUE(says("--force")) << said_;
  EXPECT_EQ(fs::file_size(folder_ / "mine.stl"), 4u);
  EXPECT_EQ(run("reconstruct closed.stl --points 300 --samples 500 -o mine.stl --force"), 0) << said_;
  EXPECT_GT(fs::file_size(folder_ / "mine.stl"), 4u);
}

}  // namespace
}  // namespace scree
