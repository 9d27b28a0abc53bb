// test_safetensors.cpp: tensors and models there and back with the same bits; damaged and lying files by one message.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>

#include "shapes/exchange/foreign_net.h"
#include "shapes/exchange/safetensors_model.h"
#include "shapes/whole_file.h"
#include "tests/support/pebble_decoder.h"
#include "tests/support/random_mlp.h"
#include "tests/support/same_library.h"

namespace scree::test {
namespace {

namespace fs = std::filesystem;

class Safetensors : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_safetensors_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    file_ = folder_ / "x.safetensors";
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string packed(std::string const& header, std::string const& data) {
    std::uint64_t const length = header.size();
    return std::string(reinterpret_cast<char const*>(&length), 8) + header + data;
  }
  // What reading `bytes` complains about; "" where it does not.
  std::string complaint(std::string const& bytes) {
    write_whole_file(file_, bytes, true);
    try {
      read_safetensors(file_);
    } catch (std::runtime_error const& e) {
      EXPECT_EQ(std::string(e.what()).find(file_.string() + ": "), 0u) << e.what();
      return e.what();
    }
    return "";
  }
  void refused(std::string const& header, std::string const& data, std::string const& part) {
    std::string const said = complaint(packed(header, data));
    EXPECT_NE(said.find(part), std::string::npos) << header << "\nsays: " << said;
  }

  fs::path folder_, file_;
};

std::string floats(std::vector<float> const& v) {
  return {reinterpret_cast<char const*>(v.data()), v.size() * sizeof(float)};
}

Library const& pebbles() {
  static Library const library = pebble_library();  // a second to make
  return library;
}

// Coded and single networks, all activations.
Library mixed_library() {
  Library library = pebbles();
  library.net.push_back(random_mlp(Activation::sine, 7.5, {3, 17, 9, 1}, 1));
  library.net.push_back(random_mlp(Activation::leaky_relu, 0.01, {3, 5, 1}, 2));
  for (int net : {1, 2}) {
    Shape s = library.shape[0];
    s.name = "single/" + std::to_string(net);
    s.net = net;
    s.code.clear();
    s.certificate.mae = 1.0 / 3 * net;
    s.certificate.source = "m\xc3\xbchle \"a\"";  // UTF-8 and quotes
    s.certificate.source_hash = "0123";
    library.shape.push_back(s);
  }
  return library;
}

TEST_F(Safetensors, FloatsKeepTheirBits) {
  TensorFile content;
  content.tensor["odd"] = {{2, 3}, {-0.0f, 1e-45f, std::numeric_limits<float>::max(), 1.0f / 3, -1, 0}};
  content.tensor["number"] = {{}, {7}};
  content.tensor["none"] = {{0, 4}, {}};
  content.metadata["key"] = "any \"text\"\n";
  write_safetensors(file_, content);
  TensorFile const back = read_safetensors(file_);
  EXPECT_EQ(back.metadata, content.metadata);
  ASSERT_EQ(back.tensor.size(), 3u);
  for (auto const& [name, tensor] : content.tensor) {
    EXPECT_EQ(back.tensor.at(name).shape, tensor.shape) << name;
    EXPECT_EQ(floats(back.tensor.at(name).value), floats(tensor.value)) << name;
  }
  EXPECT_THROW(write_safetensors(file_, content), std::runtime_error);  // it exists
  content.tensor["number"].shape = {2};
  EXPECT_THROW(write_safetensors(file_, content, true), std::invalid_argument);
  EXPECT_EQ(read_safetensors(file_).tensor.at("number").value, std::vector<float>{7});  // left as it was
}

TEST_F(Safetensors, OtherTypesBecomeFloats) {
  double const third = 1.0 / 3;
  std::string data(reinterpret_cast<char const*>(&third), 8);
  // 1.5, -2, 2^-24 (the least half), 65504 (the largest) in half precision; 1 and -0.5 in bfloat16.
  for (std::uint16_t bits : {0x3e00, 0xc000, 0x0001, 0x7bff, 0x3f80, 0xbf00})
    data.append(reinterpret_cast<char const*>(&bits), 2);
  EXPECT_EQ(complaint(packed(R"({"d":{"dtype":"F64","shape":[1],"data_offsets":[0,8]},
      "h":{"dtype":"F16","shape":[4],"data_offsets":[8,16]},"b":{"dtype":"BF16","shape":[2],"data_offsets":[16,20]}})",
                             data)),
            "");
  TensorFile const content = read_safetensors(file_);
  EXPECT_EQ(content.tensor.at("d").value, std::vector<float>{static_cast<float>(third)});
  EXPECT_EQ(content.tensor.at("h").value, (std::vector<float>{1.5f, -2, std::ldexp(1.0f, -24), 65504}));
  EXPECT_EQ(content.tensor.at("b").value, (std::vector<float>{1, -0.5f}));
}

TEST_F(Safetensors, LyingFilesAreRefused) {
  std::string const two = floats({1, 2});
  EXPECT_EQ(complaint(packed(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})", two)), "");
  EXPECT_NE(complaint("short").find("too short"), std::string::npos);
  std::string huge = packed("{}", "");
  std::memset(huge.data(), 0xff, 8);
  EXPECT_NE(complaint(huge).find("its header should be"), std::string::npos);
  refused("{", "", "is no JSON");
  refused("[]", "", "is no JSON object");
  refused(std::string(100000, '['), "", "is no JSON");
  refused("{\"\xff\":1}", "", "is no JSON");
  refused(R"({"a":1})", "", "'a': its entry is no JSON object");
  refused(R"({"a":{"shape":[2],"data_offsets":[0,8]}})", two, "dtype is missing");
  refused(R"({"a":{"dtype":"I64","shape":[1],"data_offsets":[0,8]}})", two, "dtype I64 is not read");
  refused(R"({"a":{"dtype":"F32","data_offsets":[0,8]}})", two, "shape is missing");
  refused(R"({"a":{"dtype":"F32","shape":[-2],"data_offsets":[0,8]}})", two, "no size");
  refused(R"({"a":{"dtype":"F32","shape":[2.0],"data_offsets":[0,8]}})", two, "no size");
  refused(R"({"a":{"dtype":"F32","shape":[65536,65536,4],"data_offsets":[0,8]}})", two, "too large");
  refused(R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,8]}})", two, "hold 8 bytes, its shape takes 12");
  refused(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[8,0]}})", two, "data_offsets hold");
  refused(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0]}})", two, "two numbers");
  refused(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[-8,0]}})", two, "no whole number");
  refused(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[4,12]}})", two, "there is a hole");
  refused(
      R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},"b":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}})",
      two, "they overlap");
  refused(R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[0,16]}})", two, "it is cut short");
  refused(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})", two, "there is something behind them");
  refused(
      R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},"a":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}})",
      two, "names 'a' twice");
  refused(R"({"__metadata__":3})", "", "__metadata__ is no JSON object");
  refused(R"({"__metadata__":{"k":3}})", "", "'k' is no text");
  std::string const a = R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})";
  refused(a, floats({1, NAN}), "'a' has a NaN");
  refused(a, floats({INFINITY, 1}), "'a' has a NaN or infinite");
  double const large = 1e300;  // of no float
  refused(R"({"a":{"dtype":"F64","shape":[1],"data_offsets":[0,8]}})",
          std::string(reinterpret_cast<char const*>(&large), 8), "NaN or infinite");
  EXPECT_THROW(read_safetensors(folder_), std::runtime_error);
  EXPECT_THROW(read_safetensors(folder_ / "nowhere"), std::runtime_error);
}

TEST_F(Safetensors, ModelsComeBackBitForBit) {
  Library const library = mixed_library();
  write_safetensors(file_, tensors_of(library));
  Library const back = library_of(read_safetensors(file_));
  expect_same(back, library);
}

TEST_F(Safetensors, WeightsAreAsPyTorchHoldsThem) {
  Library const library = mixed_library();
  Mlp const& net = library.net[1];
  FloatTensor const w = tensors_of(library).tensor.at("net.1.0.weight");
  EXPECT_EQ(w.shape, (std::vector<std::int64_t>{17, 3}));  // [out, in]
  EXPECT_EQ(w.value[5 * 3 + 2], net.weight[0][2 * 17 + 5]);
}

TEST_F(Safetensors, OtherShapesAreLeftOut) {
  Library library = mixed_library();
  std::size_t const networks = library.shape.size();
  Shape sphere = library.shape[0];
  sphere.name = "sphere", sphere.kind = ShapeKind::analytic, sphere.net = -1, sphere.code.clear();
  library.shape.insert(library.shape.begin(), sphere);
  EXPECT_EQ(library_of(tensors_of(library)).shape.size(), networks);
  library.shape.resize(1);
  EXPECT_THROW(tensors_of(library), std::invalid_argument);
}

TEST_F(Safetensors, MixedUpModelsAreRefused) {
  TensorFile const good = tensors_of(mixed_library());
  ASSERT_NO_THROW(library_of(good));
  auto const refused = [&](std::function<void(TensorFile&)> const& spoil, std::string const& part) {
    TensorFile content = good;
    spoil(content);
    try {
      library_of(content);
      ADD_FAILURE() << "not refused: " << part;
    } catch (std::runtime_error const& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  auto const replace = [](std::string const& key, std::string const& from, std::string const& to) {
    return [=](TensorFile& c) {
      std::size_t const at = c.metadata.at(key).find(from);
      ASSERT_NE(at, std::string::npos) << from;
      c.metadata.at(key).replace(at, from.size(), to);
    };
  };
  refused([](TensorFile& c) { c.metadata.erase("format"); }, "'format'");
  refused([](TensorFile& c) { c.metadata["version"] = "9"; }, "version 9");
  refused([](TensorFile& c) { c.metadata["sign"] = "negative_inside"; }, "sign convention");
  refused([](TensorFile& c) { c.metadata.erase("unit"); }, "'unit' is missing");
  refused([](TensorFile& c) { c.metadata["nets"] = "{"; }, "'nets' is no JSON");
  refused([](TensorFile& c) { c.metadata["nets"] = "{}"; }, "'nets' is no list");
  refused([](TensorFile& c) { c.metadata["shapes"] = "[7]"; }, "'shapes', entry 0: is no JSON object");
  refused(replace("nets", "softplus", "swish"), "unknown activation 'swish'");
  refused(replace("shapes", "\"volume\"", "\"volumen\""), "'volume' is missing");
  refused(replace("shapes", "\"net\":0", "\"net\":7"), "'net' is 7");
  refused(replace("shapes", "\"net\":0", "\"net\":1e99"), "'net' is no whole number");
  refused(replace("shapes", "\"code\":3", "\"code\":12"), "'code' 12 of 2 numbers");
  refused(replace("shapes", "\"name\":\"flat/1\"", "\"name\":\"flat/0\""), "flat/0");
  refused([](TensorFile& c) { c.tensor.erase("codes"); }, "not in tensor 'codes'");
  refused([](TensorFile& c) { c.tensor.erase("net.1.1.bias"); }, "'net.1.1.bias' is missing");
  refused([](TensorFile& c) { c.tensor["extra"] = {{1}, {1}}; }, "its metadata tells of");
  refused([](TensorFile& c) { c.tensor["net.1.1.weight"].shape = {17, 9}; }, "the layer before gives 17");
  refused([](TensorFile& c) { c.tensor["net.1.0.bias"] = {{1}, {1}}; }, "wrong size");
}

// Whatever a flipped or lost byte makes of a file, it is read or refused, never worse (run under sanitizers too).
TEST_F(Safetensors, DamageIsReadOrRefused) {
  write_safetensors(file_, tensors_of(mixed_library()));
  std::string const good = read_whole_file(file_);
  std::uint64_t header = 0;
  std::memcpy(&header, good.data(), 8);
  std::mt19937_64 random(1);
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string bytes = good;
    // Two of three in the header, where the lies would be; some files also lose their end.
    std::size_t const range = i % 3 ? 8 + header : bytes.size();
    bytes[random() % range] = static_cast<char>(random() % 2 ? random() % 256 : '0' + random() % 10);
    if (i % 7 == 0) bytes.resize(random() % bytes.size());
    std::ofstream(folder_ / "damaged", std::ios::binary) << bytes;  // without the wait for the disk
    try {
      library_of(read_safetensors(folder_ / "damaged"));
    } catch (std::runtime_error const&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(Safetensors, FiguresAreHeldAgainstTheNetwork) {
  Library library = pebbles();
  library.shape = {library.shape[2]};
  EXPECT_TRUE(false_figures(library).empty());
  auto const lie = [&](std::function<void(Shape&)> const& change, std::string const& part) {
    Library spoilt = library;
    change(spoilt.shape[0]);
    std::vector<std::string> const found = false_figures(spoilt);
    ASSERT_FALSE(found.empty()) << part;
    EXPECT_NE(found.front().find("'flat/2': " + part), std::string::npos) << found.front();
  };
  lie([](Shape& s) { s.volume *= 1.05; }, "volume");
  lie([](Shape& s) { s.bounding_radius *= 1.1; }, "bounding_radius");
  lie([](Shape& s) { s.bounding_radius *= 0.1; }, "volume");  // all that is seen of it
  lie([](Shape& s) { s.box.max.y *= 0.9; }, "box");
  lie([](Shape& s) { s.inertia.y *= 1.1; }, "inertia");
  lie([](Shape& s) { s.query.scale *= 1.1; }, "volume");
}

TEST_F(Safetensors, ForeignNetworksAreReadInTheOrderOfTheirNames) {
  // 12 layers, so that "10" must come after "2"; each of another width.
  std::vector<int> width{5};
  for (int l = 0; l < 11; ++l) width.push_back(4 + l);
  width.push_back(1);
  Mlp const net = random_mlp(Activation::sine, 5, width, 3);
  TensorFile content;
  for (int l = 0; l < net.layers(); ++l) {
    FloatTensor w{{width[l + 1], width[l]}, {}};
    for (int o = 0; o < width[l + 1]; ++o)
      for (int i = 0; i < width[l]; ++i) w.value.push_back(net.weight[l][i * width[l + 1] + o]);
    std::string const layer = "model." + std::to_string(2 * l);  // activations between them have odd numbers
    content.tensor[layer + ".weight"] = w;
    content.tensor[layer + ".bias"] = {{width[l + 1]}, net.bias[l]};
  }
  content.tensor["codes"] = {{2, 2}, {1, 2, 3, 4}};
  Mlp const back = net_of(content, {Activation::sine, 5, false});
  EXPECT_EQ(back.width, width);
  EXPECT_EQ(back.weight, net.weight);
  EXPECT_EQ(back.bias, net.bias);
  EXPECT_EQ(codes_of(content, back), (std::vector<std::vector<float>>{{1, 2}, {3, 4}}));
  Mlp const flipped = net_of(content, {Activation::sine, 5, true});
  std::vector<float> const folded = fold_code(net, std::vector<float>{1, 2});
  Vec3 const x{0.1, -0.2, 0.3};
  EXPECT_EQ(evaluate_reference(flipped, folded, x), -evaluate_reference(net, folded, x));

  auto const refused = [&](std::function<void(TensorFile&)> const& spoil, std::string const& part) {
    TensorFile bad = content;
    spoil(bad);
    try {
      codes_of(bad, net_of(bad, {}));
      ADD_FAILURE() << "not refused: " << part;
    } catch (std::runtime_error const& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  refused([](TensorFile& c) { c.tensor.erase("codes"); }, "no tensor 'codes'");
  refused([](TensorFile& c) { c.tensor["codes"].shape = {4, 1}; }, "must be [shapes, 2]");
  refused([](TensorFile& c) { c.tensor.erase("model.4.bias"); }, "has no 'model.4.bias'");
  refused([](TensorFile& c) { c.tensor["model.4.gain"] = {{1}, {1}}; }, "'model.4.gain' is neither");
  refused([](TensorFile& c) { c.tensor.erase("model.4.bias"), c.tensor.erase("model.4.weight"); }, "the layer before");
  refused([](TensorFile& c) { c.tensor.clear(); }, "at least one hidden layer");
}

}  // namespace
}  // namespace scree::test
