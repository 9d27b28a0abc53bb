// test_exchange_cli.cpp: scree-shape export and import of networks as a user meets them.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "shapes/exchange/onnx_file.h"
#include "shapes/exchange/safetensors_model.h"
#include "shapes/model_file.h"
#include "shapes/whole_file.h"
#include "tests/support/pebble_decoder.h"
#include "tests/support/same_library.h"

namespace scree::test {
namespace {

namespace fs = std::filesystem;

class Exchange : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_exchange_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    write_model(folder_ / "pebbles.h5", pebble_library());
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Exit code; what the program said, both streams, is in said_.
  int run(std::string const& arguments) {
    std::string const command = "cd '" + folder_.string() + "' && '" SCREE_SHAPE "' " + arguments + " > said.txt 2>&1";
    int const status = std::system(command.c_str());
    said_ = read_whole_file(folder_ / "said.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // `arguments` must fail as bad input, say `part`, and write no file out.*.
  void refused(std::string const& arguments, std::string const& part) {
    EXPECT_EQ(run(arguments), 2) << arguments << "\n" << said_;
    EXPECT_NE(said_.find(part), std::string::npos) << arguments << "\n" << said_;
    for (char const* name : {"out.h5", "out.stl", "out.onnx", "out.safetensors"})
      EXPECT_FALSE(fs::exists(folder_ / name)) << arguments;
  }

  fs::path folder_;
  std::string said_;
};

TEST_F(Exchange, ModelsGoOutAndComeBack) {
  ASSERT_EQ(run("export pebbles.h5 --format safetensors -o p.safetensors"), 0) << said_;
  ASSERT_EQ(run("import p.safetensors -o back.h5"), 0) << said_;
  expect_same(read_model(folder_ / "back.h5"), read_model(folder_ / "pebbles.h5"));
  refused("export pebbles.h5 --format safetensors -o p.safetensors", "--force");
  refused("import p.safetensors -o back.h5", "--force");
  EXPECT_EQ(run("import p.safetensors -o back.h5 --force"), 0) << said_;
  refused("import p.safetensors -o out.h5 --activation sine", "says its activation");
  refused("import p.safetensors -o out.stl", "write a .h5 file");
  refused("export pebbles.h5 --format safetensors --shape flat/0 -o out.safetensors", "--shape");
  if (!onnx_available()) {
    refused("export pebbles.h5 --format onnx --shape flat/0 -o out.onnx", "without ONNX");
    return;
  }
  ASSERT_EQ(run("export pebbles.h5 --format onnx --shape flat/0 -o p.onnx"), 0) << said_;
  ASSERT_EQ(run("export pebbles.h5 --format onnx --code-input -o d.onnx"), 0) << said_;
  refused("export pebbles.h5 --format onnx -o out.onnx", "choose with --shape one of: flat/0");
  refused("export pebbles.h5 --format onnx --shape flat/9 -o out.onnx", "no network 'flat/9'");
}

TEST_F(Exchange, ForeignNetworksAreNormalisedAndMeasured) {
  Library const pebbles = read_model(folder_ / "pebbles.h5");
  TensorFile content = tensors_of(pebbles);
  content.metadata.clear();
  content.tensor["codes"] = {{1, 2}, {0.0f, 0.1f}};
  write_safetensors(folder_ / "theirs.safetensors", content);
  std::string const convention = " --activation softplus --parameter 8 --radius 1.6";
  ASSERT_EQ(run("import theirs.safetensors -o ours.h5 --name pebble" + convention), 0) << said_;
  Library const back = read_model(folder_ / "ours.h5");
  ASSERT_EQ(back.shape.size(), 1u);
  EXPECT_EQ(back.shape[0].name, "pebble");
  EXPECT_EQ(back.shape[0].certificate.components, 1);
  EXPECT_GT(back.shape[0].certificate.gradient_p1, 0.5);
  // flat/0 has that code; it was normalised on half as fine a grid, whose error goes with the square of its cell.
  Vec3 const x{0.3, 0.2, -0.1};
  EXPECT_NEAR(evaluate_reference(back, back.shape[0], x), evaluate_reference(pebbles, pebbles.shape[0], x), 1e-3);

  refused("import theirs.safetensors -o out.h5", "say --activation");
  refused("import theirs.safetensors -o out.h5 --negative-inside" + convention, "phi is positive");
  refused("import theirs.safetensors -o out.h5 --activation voodoo --parameter 1", "voodoo");
  std::string const bytes = read_whole_file(folder_ / "theirs.safetensors");
  write_whole_file(folder_ / "cut.safetensors", bytes.substr(0, bytes.size() - 3), false);
  refused("import cut.safetensors -o out.h5" + convention, "cut.safetensors: its tensors take");
  write_whole_file(folder_ / "rock.stl", "solid nothing", false);
  refused("import rock.stl -o out.stl --activation sine", "are for networks");
}

TEST_F(Exchange, FilesThatLieAboutTheirGrainsAreRefused) {
  Library library = read_model(folder_ / "pebbles.h5");
  library.shape.resize(1);
  library.shape[0].inertia.x *= 1.2;
  write_safetensors(folder_ / "lie.safetensors", tensors_of(library));
  refused("import lie.safetensors -o out.h5", "'flat/0': inertia is not what its network gives");
}

}  // namespace
}  // namespace scree::test
