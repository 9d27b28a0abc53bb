// test_model_file.cpp: what goes into a model file comes out bit for bit, and bad files are named and refused.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <tuple>

#include "shapes/file_container.h"
#include "shapes/hdf5_handle.h"
#include "shapes/model_file.h"
#include "tests/support/shape_kinds.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

Mlp random_net(std::vector<int> width, Activation activation, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-1, 1);
  Mlp net;
  net.activation = activation;
  net.parameter = activation == Activation::leaky_relu ? 0.1 : 5.0;
  net.width = std::move(width);
  for (int l = 0; l < net.layers(); ++l) {
    net.weight.emplace_back(std::size_t(net.width[l]) * net.width[l + 1]);
    net.bias.emplace_back(net.width[l + 1]);
    // Small enough that the derivatives of the whole network stay of order 1.
    float const size = 1 / (static_cast<float>(net.parameter) * std::sqrt(static_cast<float>(net.width[l])));
    for (float& w : net.weight.back()) w = number(random) * size;
    for (float& b : net.bias.back()) b = number(random);
  }
  return net;
}

// Every field away from its default, no two alike, with fractions no decimal notation would keep.
Shape random_shape(std::string const& name, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(0.5, 1.5);
  Shape s;
  s.name = name;
  s.volume = number(random);
  s.area = number(random);
  s.inertia = {number(random), number(random), number(random)};
  s.bounding_radius = number(random);
  s.box = {{-number(random), -number(random), -number(random)}, {number(random), number(random), number(random)}};
  s.lipschitz = number(random);
  Certificate& c = s.certificate;
  for (double* v : {&c.mae, &c.p99, &c.max, &c.band_mae, &c.band_p99, &c.band_max, &c.normal_p50, &c.normal_p95,
                    &c.flat_normal_p95, &c.flat_share, &c.hausdorff, &c.volume_error, &c.inertia_error, &c.gradient_p1,
                    &c.gradient_p5, &c.gradient_p95, &c.gradient_p99, &c.falling, &c.gap})
    *v = number(random);
  c.components = 1;
  c.euler = -2;
  c.gap_nodes = 3999;
  c.seed = std::int64_t{1} << 60 | seed;  // beyond what a double holds
  c.source = "superellipsoid 1:0.8:0.6 µ";
  c.source_hash = "abcdef";
  return s;  // made_with stays empty: empty strings must survive too
}

Library coded_library(int shapes) {
  Library library;
  library.net.push_back(random_net({13, 64, 64, 64, 64, 64, 64, 1}, Activation::sine, 1));
  library.net.push_back(random_net({3, 8, 8, 1}, Activation::leaky_relu, 2));
  for (int i = 0; i < shapes; ++i) {
    Shape s = random_shape("ballast/" + std::to_string(i), 10 + i);
    s.kind = ShapeKind::net;
    s.net = i == 3 ? 1 : 0;
    if (s.net == 0)
      for (int k = 0; k < 10; ++k) s.code.push_back(0.1f * static_cast<float>(k - i));
    s.query.rotation = to_matrix(normalized(Quat{1, 0.3 * i, -0.2, 0.5}));
    s.query.shift = {0.1 * i, 1.0 / 3, -0.2};
    s.query.scale = 1 + i / 7.0;
    library.shape.push_back(s);
  }
  Shape formula = random_shape("ballast", 99);  // a name that is the prefix of others
  formula.analytic = {AnalyticKind::superellipsoid, {0.6, 0.5, 1.0 / 3}, 0.7, 1.3};
  library.shape.push_back(formula);
  return library;
}

template <class T>
bool same_bits(std::vector<T> const& a, std::vector<T> const& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_bits(Vec3 a, Vec3 b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

void expect_same(Shape const& a, Shape const& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.analytic.kind, b.analytic.kind);
  EXPECT_TRUE(same_bits(a.analytic.half_size, b.analytic.half_size));
  EXPECT_EQ(a.analytic.exponent_ns, b.analytic.exponent_ns);
  EXPECT_EQ(a.analytic.exponent_ew, b.analytic.exponent_ew);
  EXPECT_EQ(a.net, b.net);
  EXPECT_TRUE(same_bits(a.code, b.code));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(same_bits(a.query.rotation.row[i], b.query.rotation.row[i]));
  EXPECT_TRUE(same_bits(a.query.shift, b.query.shift));
  EXPECT_EQ(a.query.scale, b.query.scale);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.area, b.area);
  EXPECT_TRUE(same_bits(a.inertia, b.inertia));
  EXPECT_EQ(a.bounding_radius, b.bounding_radius);
  EXPECT_TRUE(same_bits(a.box.min, b.box.min));
  EXPECT_TRUE(same_bits(a.box.max, b.box.max));
  EXPECT_EQ(a.lipschitz, b.lipschitz);
  Certificate const &c = a.certificate, &d = b.certificate;
  EXPECT_EQ(std::tie(c.mae, c.p99, c.max), std::tie(d.mae, d.p99, d.max));
  EXPECT_EQ(std::tie(c.band_mae, c.band_p99, c.band_max), std::tie(d.band_mae, d.band_p99, d.band_max));
  EXPECT_EQ(std::tie(c.normal_p50, c.normal_p95, c.flat_normal_p95, c.flat_share),
            std::tie(d.normal_p50, d.normal_p95, d.flat_normal_p95, d.flat_share));
  EXPECT_EQ(std::tie(c.gradient_p1, c.gradient_p5, c.gradient_p95, c.gradient_p99),
            std::tie(d.gradient_p1, d.gradient_p5, d.gradient_p95, d.gradient_p99));
  EXPECT_EQ(std::tie(c.volume_error, c.inertia_error, c.hausdorff),
            std::tie(d.volume_error, d.inertia_error, d.hausdorff));
  EXPECT_EQ(std::tie(c.falling, c.gap, c.gap_nodes, c.components, c.euler),
            std::tie(d.falling, d.gap, d.gap_nodes, d.components, d.euler));
  EXPECT_EQ(std::tie(c.seed, c.source, c.source_hash, c.made_with),
            std::tie(d.seed, d.source, d.source_hash, d.made_with));
}

class ModelFile : public ::testing::Test {
 protected:
  ModelFile() {
    folder = fs::temp_directory_path() / ("scree_model_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    file = folder / "grains.h5";
  }
  ~ModelFile() override { fs::remove_all(folder); }

  std::string read_complaint() {
    try {
      read_model(file);
    } catch (std::runtime_error const& e) {
      return e.what();
    }
    return "";
  }
  std::string write_complaint(Library const& library, bool overwrite = true) {
    try {
      write_model(file, library, overwrite);
    } catch (std::runtime_error const& e) {
      return e.what();
    }
    return "";
  }
  // Change a finished model with `edit` and seal it again, as a foreign program with our container code could.
  template <class Edit>
  void tamper(Edit const& edit) {
    hdf5::QuietErrors const quiet;
    fs::path const copy = folder / "copy.h5";
    fs::copy_file(file, copy, fs::copy_options::overwrite_existing);
    {
      hdf5::Handle const h(H5Fopen(copy.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "open");
      edit(static_cast<hid_t>(h));
    }
    seal_container(copy, file, "scree.model", 1);
  }
  fs::path folder, file;
};

TEST_F(ModelFile, EverythingComesBackBitForBit) {
  Library const library = coded_library(20);
  write_model(file, library);
  Library const back = read_model(file);
  ASSERT_EQ(back.net.size(), library.net.size());
  for (std::size_t k = 0; k < back.net.size(); ++k) {
    EXPECT_EQ(back.net[k].activation, library.net[k].activation);
    EXPECT_EQ(back.net[k].parameter, library.net[k].parameter);
    EXPECT_EQ(back.net[k].width, library.net[k].width);
    for (int l = 0; l < library.net[k].layers(); ++l) {
      EXPECT_TRUE(same_bits(back.net[k].weight[l], library.net[k].weight[l]));
      EXPECT_TRUE(same_bits(back.net[k].bias[l], library.net[k].bias[l]));
    }
  }
  ASSERT_EQ(back.shape.size(), library.shape.size());
  for (std::size_t i = 0; i < back.shape.size(); ++i) expect_same(back.shape[i], library.shape[i]);
  EXPECT_LT(fs::file_size(file), 1000000u);  // the library's budget: 20 shapes, 6x64
  for (auto const& entry : fs::directory_iterator(folder)) EXPECT_EQ(entry.path(), file);  // no temporary is left
}

std::uint32_t version_of(fs::path const& file) {
  std::ifstream in(file, std::ios::binary);
  std::uint32_t version = 0;
  in.seekg(40);  // after the magic number and the kind
  in.read(reinterpret_cast<char*>(&version), sizeof(version));
  return version;
}

// Programs that know networks and formulas only go on reading files that hold nothing else.
TEST_F(ModelFile, TheVersionIsThatOfItsContent) {
  write_model(file, coded_library(2));
  EXPECT_EQ(version_of(file), 1u);
  write_model(file, testing::library_of_kind("harmonics"), true);
  EXPECT_EQ(version_of(file), 2u);
}

TEST_F(ModelFile, BrokenPartsAreNamed) {
  struct Case {
    char const* kind;
    std::function<void(hid_t)> edit;
    char const* expected;
  };
  auto const replace_integer = [](hid_t h, char const* group, char const* name, std::int64_t value) {
    hdf5::Handle const g = hdf5::open_group(h, group);
    H5Adelete(g, name);
    hdf5::write_attribute(g, name, value);
  };
  Case const cases[] = {
      {"harmonics", [](hid_t h) { H5Ldelete(h, "/harmonics/0/coefficients", H5P_DEFAULT); },
       "/harmonics/0: dataset 'coefficients' is missing"},
      {"mesh", [](hid_t h) { H5Ldelete(h, "/mesh/0/triangle", H5P_DEFAULT); },
       "/mesh/0: dataset 'triangle' is missing"},
      {"mesh",
       [](hid_t h) {
         hdf5::Handle const set(H5Dopen2(h, "/mesh/0/triangle", H5P_DEFAULT), H5Dclose, "open");
         std::vector<int> const bad(60, 12);
         H5Dwrite(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, bad.data());
       },
       "/mesh/0: a triangle names vertex 12"},
      {"mesh", [&](hid_t h) { replace_integer(h, "/shape/mesh", "data", 3); }, "mesh 3 does not exist"},
      {"grid",
       [](hid_t h) {
         hdf5::Handle const g = hdf5::open_group(h, "/grid/0");
         double const points[3] = {9, 9, 9};
         H5Adelete(g, "points");
         hdf5::write_attribute(g, "points", points, 3);
       },
       "/grid/0: its values do not have the size"},
      {"grid", [](hid_t h) { H5Ldelete(h, "/grid/0", H5P_DEFAULT); }, "grid 0 does not exist (there are 0)"},
  };
  for (Case const& c : cases) {
    write_model(file, testing::library_of_kind(c.kind), true);
    tamper(c.edit);
    std::string const complaint = read_complaint();
    EXPECT_NE(complaint.find(c.expected), std::string::npos) << c.expected << " | " << complaint;
    EXPECT_EQ(complaint.rfind(file.string(), 0), 0u) << complaint;
  }
}

TEST_F(ModelFile, EmptyLibraryIsLegal) {
  write_model(file, {});
  Library const back = read_model(file);
  EXPECT_TRUE(back.net.empty() && back.shape.empty());
}

TEST_F(ModelFile, NothingIsOverwrittenUnasked) {
  write_model(file, coded_library(1));
  EXPECT_NE(write_complaint(coded_library(2), false).find("exists already"), std::string::npos);
  EXPECT_EQ(read_model(file).shape.size(), 2u);
  write_model(file, coded_library(2), true);
  EXPECT_EQ(read_model(file).shape.size(), 3u);
}

TEST_F(ModelFile, InvalidLibrariesAreNotWritten) {
  Library nan_weight = coded_library(2);
  nan_weight.net[0].weight[3][7] = std::numeric_limits<float>::quiet_NaN();
  Library bad_code = coded_library(2);
  bad_code.shape[1].code.pop_back();
  Library bad_volume = coded_library(2);
  bad_volume.shape[0].volume = std::numeric_limits<double>::infinity();
  Library mirrored = coded_library(2);
  mirrored.shape[1].query.rotation.row[0] = -mirrored.shape[1].query.rotation.row[0];
  Library twice = coded_library(2);
  twice.shape[1].name = twice.shape[0].name;
  Library bad_name = coded_library(2);
  bad_name.shape[1].name = "ballast//1";
  struct Case {
    Library const& library;
    char const* expected;
  };
  for (Case const& c : {Case{nan_weight, "network 0: layer 3"}, Case{bad_code, "shape 'ballast/1': the code"},
                        Case{bad_volume, "shape 'ballast/0': volume"}, Case{mirrored, "proper rotation"},
                        Case{twice, "taken twice"}, Case{bad_name, "ballast//1"}}) {
    std::string const complaint = write_complaint(c.library);
    EXPECT_NE(complaint.find(c.expected), std::string::npos) << complaint;
    EXPECT_EQ(complaint.rfind(file.string(), 0), 0u) << complaint;
    EXPECT_FALSE(fs::exists(file));
  }
}

TEST_F(ModelFile, UnwritableFolderIsNamed) {
  file = folder / "missing" / "grains.h5";
  EXPECT_NE(write_complaint(coded_library(1)).find("missing/grains.h5: cannot be created"), std::string::npos);
}

TEST_F(ModelFile, DamagedFilesNeverReachHdf5) {
  write_model(file, coded_library(2));
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_NE(read_complaint().find("cut short"), std::string::npos);
  write_model(file, coded_library(2), true);
  {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(40000);
    stream.put('\x55').put('\x2a');
  }
  EXPECT_NE(read_complaint().find("damaged"), std::string::npos);
}

TEST_F(ModelFile, WrongContentIsNamedByLayerOrShape) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  auto const replace_double = [](hid_t h, char const* group, char const* name, double value) {
    hdf5::Handle const g = hdf5::open_group(h, group);
    H5Adelete(g, name);
    hdf5::write_attribute(g, name, &value, 1);
  };
  auto const replace_integer = [](hid_t h, char const* group, char const* name, std::int64_t value) {
    hdf5::Handle const g = hdf5::open_group(h, group);
    H5Adelete(g, name);
    hdf5::write_attribute(g, name, value);
  };
  struct Case {
    std::function<void(hid_t)> edit;
    char const* expected;
  };
  Case const cases[] = {
      {[&](hid_t h) { replace_double(h, "/shape/ballast/1", "volume", nan); }, "shape 'ballast/1': volume"},
      {[&](hid_t h) { replace_integer(h, "/shape/ballast/1", "net", 7); }, "/shape/ballast/1: attribute 'net' = 7"},
      {[&](hid_t h) { replace_integer(h, "/shape/ballast/1", "code", 2); }, "/shape/ballast/1: attribute 'code' = 2"},
      {[&](hid_t h) { replace_integer(h, "/shape/ballast/1", "index", 0); }, "out of range or taken"},
      {[&](hid_t h) { replace_double(h, "/net/0", "parameter", -1); }, "network 0"},
      {[&](hid_t h) { H5Adelete_by_name(h, "/shape/ballast/0", "area", H5P_DEFAULT); }, "'area' is missing"},
      {[&](hid_t h) { H5Ldelete(h, "/net/1", H5P_DEFAULT); }, "/net/1: group /net/1 is missing"},
      {[&](hid_t h) { H5Ldelete(h, "/net/0/b2", H5P_DEFAULT); }, "/net/0: dataset 'b2' is missing"},
      {[&](hid_t h) { H5Ldelete(h, "/net/0/w6", H5P_DEFAULT); }, "network 0: the output width"},
      {[&](hid_t h) { H5Ldelete(h, "/shape/ballast/0", H5P_DEFAULT); }, "shape 0: the name ''"},
      {[&](hid_t h) { H5Ldelete(h, "/shape/ballast/0/certificate", H5P_DEFAULT); }, "certificate is missing"},
      {[&](hid_t h) {
         hdf5::Handle const set(H5Dopen2(h, "/net/0/w2", H5P_DEFAULT), H5Dclose, "open");
         std::vector<float> const bad(64 * 64, std::numeric_limits<float>::infinity());
         H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, bad.data());
       },
       "network 0: layer 2"},
  };
  for (Case const& c : cases) {
    write_model(file, coded_library(2), true);
    tamper(c.edit);
    std::string const complaint = read_complaint();
    EXPECT_NE(complaint.find(c.expected), std::string::npos) << c.expected << " | " << complaint;
    EXPECT_EQ(complaint.rfind(file.string(), 0), 0u) << complaint;
  }
}

// Files written before a figure existed: it reads as not measured.
TEST_F(ModelFile, AnAbsentFigureWasNotMeasured) {
  write_model(file, coded_library(2));
  tamper([](hid_t h) {
    for (char const* name : {"falling", "euler", "gap_nodes"})
      H5Adelete_by_name(h, "/shape/ballast/1/certificate", name, H5P_DEFAULT);
  });
  Library const back = read_model(file);
  Certificate const& c = back.shape[1].certificate;
  EXPECT_EQ(c.falling, -1);
  EXPECT_EQ(c.euler, 1);
  EXPECT_EQ(c.gap_nodes, -1);
  EXPECT_EQ(c.components, 1);
  EXPECT_EQ(back.shape[0].certificate.euler, -2);
}

TEST(EvaluateReference, QueryTransformIsARigidMotionAndAScale) {
  Library library = coded_library(1);
  Shape plain = library.shape[0];
  plain.query = {};
  Shape const& moved = library.shape[0];
  Vec3 const x{0.2, -0.1, 0.3};
  Vec3 gradient, plain_gradient;
  double const phi = evaluate_reference(library, moved, x, &gradient);
  Vec3 const x_net = moved.query.rotation * (x * moved.query.scale) + moved.query.shift;
  EXPECT_DOUBLE_EQ(phi, evaluate_reference(library, plain, x_net, &plain_gradient) / moved.query.scale);
  EXPECT_NEAR(norm(gradient), norm(plain_gradient), 1e-12 * norm(plain_gradient));
  double const h = 1e-6;  // central difference: error h^2 phi''' ~ 1e-11, rounding 1e-16 / h = 1e-10
  for (int i = 0; i < 3; ++i) {
    Vec3 up = x, down = x;
    up[i] += h;
    down[i] -= h;
    double const slope = (evaluate_reference(library, moved, up) - evaluate_reference(library, moved, down)) / (2 * h);
    EXPECT_NEAR(gradient[i], slope, 1e-8);
  }
}

TEST(EvaluateReference, AnalyticShapesAreTheirFormula) {
  Library library;
  Shape sphere;
  sphere.analytic = {AnalyticKind::sphere, {0.5, 0.5, 0.5}, 1, 1};
  Vec3 gradient;
  EXPECT_DOUBLE_EQ(evaluate_reference(library, sphere, {0, 0.3, 0.4}, &gradient), 0.0);
  EXPECT_NEAR(norm(gradient - Vec3{0, -0.6, -0.8}), 0, 1e-15);
}

}  // namespace
}  // namespace scree
