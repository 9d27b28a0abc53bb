// unique_grains_test.cpp: compact grains in a scene: bytes by the process's own memory, the same bodies through cases
// and codes, fallbacks, and the meter itself.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <cmath>
#include <filesystem>

#include "core/process_memory.h"
#include "core/simulation_impl.h"
#include "core/unique_grains.h"
#include "kernels/node_access.h"
#include "shapes/model_file.h"
#include "shapes/random.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;

std::filesystem::path const library_file = std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5";

#if defined(__SANITIZE_ADDRESS__)
bool constexpr memory_is_the_programs = false;  // red zones, quarantine and shadow are the sanitizer's
#else
bool constexpr memory_is_the_programs = true;
#endif

bool one_arena() {
#if defined(__GLIBC__)
  return mallopt(M_ARENA_MAX, 1) == 1;
#else
  return false;
#endif
}

std::vector<float> codes_near(Library const& library, int count) {
  Random random(7);
  std::vector<float> codes;
  for (int i = 0; i < count; ++i)
    for (float c : library.shape[i % 10].code) codes.push_back(c + 0.02f * static_cast<float>(random.normal()));
  return codes;
}

TEST(ProcessMemory, CountsWhatWasTouchedAndForgetsWhatWasFreed) {
  if (!memory_is_the_programs) GTEST_SKIP() << "address sanitizer keeps memory of its own";
  std::size_t const size = 64 << 20, before = resident_bytes();
  {
    std::unique_ptr<char[]> const block(new char[size]);  // not written to
    EXPECT_LT(resident_bytes(), before + size / 50);
    for (std::size_t i = 0; i < size; i += 1024) block[i] = 1;
    EXPECT_NEAR(static_cast<double>(resident_bytes() - before) / static_cast<double>(size), 1, 0.02);
    ASSERT_EQ(block[1024], 1);
  }
  EXPECT_LT(resident_bytes(), before + size / 50);
}

// The bar of the format: 3 kB a grain at 1,000 nodes, everything a scene keeps of it included.
TEST(UniqueGrains, AGrainTakesLessThanThreeKilobytesOfProcessMemory) {
  // An arena for each thread would leave pages half full, differently in every run: the allocator's, not a grain's.
  bool const arena_is_one = one_arena();
  int const count = memory_is_the_programs ? 1500 : 100;
  Library const library = read_model(library_file);
  CompactGrainMaker const maker(library, 0, 1000);
  std::vector<float> const codes = codes_near(library, count);
  Scene scene, first;
  int const net = scene_network(scene, library.net[0]);
  // Threads, scratch and code come once; they are not part of a grain.
  add_unique_grains(first, maker, scene_network(first, library.net[0]), Span<const float>(codes).subspan(0, 1000), "",
                    2);
  std::size_t const before = resident_bytes();
  UniqueGrainsMade const made = add_unique_grains(scene, maker, net, codes, "grain/", 2);
  double const resident = static_cast<double>(resident_bytes() - before) / made.made;
  EXPECT_GT(made.made, count * 9 / 10);
  CompactBytes const bytes = compact_bytes(scene);
  ASSERT_EQ(bytes.grains, static_cast<std::size_t>(made.made));
  double const counted = static_cast<double>(bytes.total()) / made.made;
  printf("%d grains: %.0f bytes each by the process, %.0f by the arrays\n", made.made, resident, counted);
  // Refused codes leave their room empty: untouched by the process, counted by the arrays.
  EXPECT_LT(counted * made.made / count, 3000);
  if (!memory_is_the_programs || !arena_is_one) return;
  EXPECT_LT(resident, 3000);
  EXPECT_GT(resident, 2000);  // 16 bits a node alone
}

TEST(UniqueGrains, ATemplateIsTheShapeThatItsCodeMakes) {
  Library const library = read_model(library_file);
  CompactGrainMaker const maker(library, 0, 250);
  std::vector<float> codes = library.shape[2].code;
  for (int of : {19, 7}) codes.insert(codes.end(), library.shape[of].code.begin(), library.shape[of].code.end());
  Scene scene;
  scene.library.shape.push_back(library.shape[0]);  // an ordinary template before them
  scene.shape.emplace_back();
  int const net = scene_network(scene, library.net[0]);
  UniqueGrainsMade const made = add_unique_grains(scene, maker, net, codes, "made/", 1);
  EXPECT_EQ(made.made, 2);
  EXPECT_EQ(made.faults[static_cast<int>(GrainFault::not_star_shaped)], 1);
  ASSERT_EQ(scene.shape.size(), 3u);
  EXPECT_EQ(scene.template_shape(0).name, library.shape[0].name);
  int const of[2] = {2, 7};
  for (int i = 0; i < 2; ++i) {
    Shape const s = scene.template_shape(1 + i), &from = library.shape[of[i]];
    EXPECT_EQ(s.name, "made/" + std::to_string(i));
    EXPECT_EQ(s.code, from.code);
    EXPECT_NEAR(s.query.scale / from.query.scale, 1, 1e-3);  // 250 nodes
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(s.inertia[k] / from.inertia[k], 1, 5e-3);
      EXPECT_NEAR(s.box.max[k], from.box.max[k], 5e-3);
    }
    SceneView const view = scene.view();
    ShapeRecord const& record = view.shape[1 + i];
    EXPECT_EQ(record.nodes, 250 + 63 + 1);
    for (int k = 0; k < 250; ++k) {
      double const phi = evaluate_reference(library, s, node_position(view.nodes, record, k));
      ASSERT_LT(std::abs(phi), 1e-5) << "node " << k;
    }
  }
  EXPECT_EQ(problems(Library{scene.library.net, {}, {}, {}, {scene.template_shape(1)}}), std::vector<std::string>{});
}

Case falling(std::vector<std::string> const& shapes) {
  Case c = rock_case();
  c.library = {{"grains", library_file}};
  GrainsCase g = grains_at("sphere", {{0, 0, 0.2}, {0.3, 0, 0.2}}, 0.1, 250);
  g.shapes = shapes;
  g.storage = NodeStorage::compact;
  c.grains = {g};
  c.wall = {floor_at(0)};
  return c;
}

TEST(UniqueGrains, PlanTellsTheBytesOfCompactGrains) {
  Simulation s(falling({"grains:cobble/0", "grains:ballast/1"}), {});
  EXPECT_EQ(s.impl().scene.compact.record.size(), 2u);
  EXPECT_TRUE(s.impl().scene.node_position.empty());
  bool told = false;
  for (std::string const& note : s.plan().notes) told = told || note.find("2 compact grains of ") == 0;
  EXPECT_TRUE(told);
}

TEST(UniqueGrains, ABodyThatRaysCannotDescribeKeepsArrays) {
  Simulation s(falling({"grains:sand/4", "grains:sand/0"}), {});
  Scene const& scene = s.impl().scene;
  EXPECT_EQ(scene.compact.record.size(), 1u);
  EXPECT_FALSE(scene.node_position.empty());
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("sand/4"), std::string::npos) << scene.notes[0];
  EXPECT_NE(scene.notes[0].find("not star-shaped"), std::string::npos) << scene.notes[0];
}

TEST(UniqueGrains, CompactStorageOfAFormulaIsRefused) {
  try {
    Simulation s(falling({"ellipsoid:1:0.8:0.6"}), {});
    FAIL() << "a formula has no code to make a compact grain from";
  } catch (InputError const& e) {
    ASSERT_EQ(e.problems.size(), 1u);
    EXPECT_NE(e.problems[0].find("storage = \"explicit\""), std::string::npos) << e.problems[0];
  }
}

}  // namespace
}  // namespace scree
