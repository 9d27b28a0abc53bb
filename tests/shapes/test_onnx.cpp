// test_onnx.cpp: phi of exported ONNX models, evaluated by a runtime that is not ours, against the double reference.
// The runtime is the Python module onnxruntime of $SCREE_ONNX_PYTHON or /usr/bin/python3; without it these tests skip.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "shapes/exchange/onnx_file.h"
#include "shapes/whole_file.h"
#include "tests/support/pebble_decoder.h"
#include "tests/support/random_mlp.h"

namespace scree::test {
namespace {

namespace fs = std::filesystem;

Library const& pebbles() {
  static Library const library = pebble_library();  // codes of two numbers and a query transform each
  return library;
}

int constexpr no_runtime = 77;  // exit code of the script

class Onnx : public testing::Test {
 protected:
  void SetUp() override {
    if (!onnx_available()) GTEST_SKIP() << "built without ONNX";
    folder_ = fs::temp_directory_path() / ("scree_onnx_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  // phi of the model at the points; empty where there is no runtime. What the script printed is in said_.
  std::vector<float> run(std::string const& model, std::vector<Vec3f> const& point, std::vector<float> const& code) {
    char const* const chosen = std::getenv("SCREE_ONNX_PYTHON");
    write_whole_file(folder_ / "m.onnx", model, true);
    write_whole_file(folder_ / "x", {reinterpret_cast<char const*>(point.data()), point.size() * sizeof(Vec3f)}, true);
    write_whole_file(folder_ / "c", {reinterpret_cast<char const*>(code.data()), code.size() * sizeof(float)}, true);
    std::string const command = "cd '" + folder_.string() + "' && '" + (chosen ? chosen : "/usr/bin/python3") +
                                "' '" SCREE_SOURCE_DIR "/tests/support/onnx_phi.py' m.onnx x " +
                                (code.empty() ? "-" : "c") + " phi > said.txt 2>&1";
    int const status = std::system(command.c_str());
    int const exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    said_ = read_whole_file(folder_ / "said.txt");
    if (exit_code == no_runtime || exit_code == 127) return {};
    EXPECT_EQ(exit_code, 0) << said_;
    std::string const bytes = exit_code == 0 ? read_whole_file(folder_ / "phi") : "";
    std::vector<float> phi(bytes.size() / sizeof(float));
    std::memcpy(phi.data(), bytes.data(), bytes.size());
    return phi;
  }

  fs::path folder_;
  std::string said_;
};

#define SKIP_WITHOUT_RUNTIME(phi) \
  if ((phi).empty() && !HasFailure()) GTEST_SKIP() << "no onnxruntime: set SCREE_ONNX_PYTHON to a Python that has it"

// A float network of order one rounds by a few 1e-7 a layer; 1e-5 is what the issue asks for.
double constexpr tolerance = 1e-5;

TEST_F(Onnx, EveryActivationGivesOurPhi) {
  std::vector<Vec3f> const point = random_points(500, 0.7, 5);
  for (auto [activation, parameter] :
       {std::pair{Activation::leaky_relu, 0.01}, {Activation::sine, 10.0}, {Activation::softplus, 20.0}}) {
    Library library;
    library.net.push_back(random_mlp(activation, parameter, {3, 40, 40, 40, 40, 40, 1}, 7));
    Shape shape;
    shape.name = "rock";
    shape.kind = ShapeKind::net;
    shape.net = 0;
    std::vector<float> const phi = run(onnx_model(library, shape), point, {});
    SKIP_WITHOUT_RUNTIME(phi);
    ASSERT_EQ(phi.size(), point.size()) << said_;
    double largest = 0;
    for (std::size_t i = 0; i < phi.size(); ++i) {
      double const ours = evaluate_reference(library, shape, to_double(point[i]));
      ASSERT_NEAR(phi[i], ours, tolerance) << to_string(activation);
      largest = std::max(largest, std::abs(ours));
    }
    EXPECT_GT(largest, 0.1) << "the network says nothing";
    EXPECT_NE(said_.find("sign=positive_inside"), std::string::npos) << said_;
    EXPECT_NE(said_.find("unit=d"), std::string::npos) << said_;
  }
}

TEST_F(Onnx, CodesAndTransformsAreFoldedIn) {
  Library const& library = pebbles();
  std::vector<Vec3f> const point = random_points(500, 0.7, 6);
  for (int i : {1, 4}) {
    Shape const& shape = library.shape[i];
    std::vector<float> const phi = run(onnx_model(library, shape), point, {});
    SKIP_WITHOUT_RUNTIME(phi);
    ASSERT_EQ(phi.size(), point.size()) << said_;
    for (std::size_t p = 0; p < phi.size(); ++p)
      ASSERT_NEAR(phi[p], evaluate_reference(library, shape, to_double(point[p])), tolerance) << shape.name;
  }
}

TEST_F(Onnx, DecodersTakeACode) {
  Library const& library = pebbles();
  std::vector<Vec3f> const point = random_points(500, 0.7, 8);
  Shape const& shape = library.shape[2];
  std::vector<float> const phi = run(onnx_decoder(library, 0), point, shape.code);
  SKIP_WITHOUT_RUNTIME(phi);
  ASSERT_EQ(phi.size(), point.size()) << said_;
  std::vector<float> const bias = fold_code(library.net[0], shape.code);
  for (std::size_t p = 0; p < phi.size(); ++p)
    ASSERT_NEAR(phi[p], evaluate_reference(library.net[0], bias, to_double(point[p])), tolerance);
  EXPECT_NE(said_.find("\"name\":\"flat/2\""), std::string::npos) << said_;
}

TEST_F(Onnx, OnlyNetworks) {
  Library library = pebbles();
  Shape sphere = library.shape[0];
  sphere.kind = ShapeKind::analytic;
  EXPECT_THROW(onnx_model(library, sphere), std::invalid_argument);
  library.net.push_back(random_mlp(Activation::sine, 7, {3, 8, 1}, 1));
  EXPECT_THROW(onnx_decoder(library, 1), std::invalid_argument);                            // takes no code
  EXPECT_EQ(onnx_model(library, library.shape[0]), onnx_model(library, library.shape[0]));  // same bytes
}

}  // namespace
}  // namespace scree::test
