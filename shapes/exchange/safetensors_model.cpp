// safetensors_model.cpp: see safetensors_model.h. JSON prints doubles so that they come back with the same bits.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/exchange/safetensors_model.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "shapes/zero_set.h"

namespace scree {
namespace {

using nlohmann::json;

char constexpr format_name[] = "scree.model";
char constexpr format_version[] = "1";

[[noreturn]] void fail(std::string const& what) { throw std::runtime_error(what); }

std::string layer_name(std::size_t net, int layer, char const* part) {
  return "net." + std::to_string(net) + "." + std::to_string(layer) + "." + part;
}

json to_json(Vec3 v) { return {v.x, v.y, v.z}; }

json to_json(Shape const& s, int code_row) {
  json certificate;
  for_each_figure(s.certificate, [&](char const* name, auto const& value) { certificate[name] = value; });
  Mat3 const& r = s.query.rotation;
  return {{"name", s.name},
          {"net", s.net},
          {"code", code_row},
          {"query_rotation", {to_json(r.row[0]), to_json(r.row[1]), to_json(r.row[2])}},
          {"query_shift", to_json(s.query.shift)},
          {"query_scale", s.query.scale},
          {"volume", s.volume},
          {"area", s.area},
          {"inertia", to_json(s.inertia)},
          {"bounding_radius", s.bounding_radius},
          {"box_min", to_json(s.box.min)},
          {"box_max", to_json(s.box.max)},
          {"lipschitz", s.lipschitz},
          {"certificate", certificate}};
}

void read_value(json const& j, double& value) {
  if (!j.is_number()) fail("is no number");
  value = j.get<double>();
}
void read_value(json const& j, std::int64_t& value) {
  if (!j.is_number_integer() || (j.is_number_unsigned() && j.get<std::uint64_t>() > std::uint64_t(INT64_MAX)))
    fail("is no whole number");
  value = j.get<std::int64_t>();
}
void read_value(json const& j, int& value) {
  std::int64_t wide = 0;
  read_value(j, wide);
  if (wide < -(1 << 24) || wide > 1 << 24) fail("is out of range");
  value = static_cast<int>(wide);
}
void read_value(json const& j, std::string& value) {
  if (!j.is_string()) fail("is no text");
  value = j.get<std::string>();
}
void read_value(json const& j, Vec3& value) {
  if (!j.is_array() || j.size() != 3) fail("is no list of three");
  for (int k = 0; k < 3; ++k) read_value(j[static_cast<std::size_t>(k)], value[k]);
}
void read_value(json const& j, Mat3& value) {
  if (!j.is_array() || j.size() != 3) fail("is no list of three");
  for (int k = 0; k < 3; ++k) read_value(j[static_cast<std::size_t>(k)], value.row[k]);
}

// j[key]; messages name the key.
template <class T>
void read(json const& j, char const* key, T& value) {
  auto const at = j.find(key);
  if (at == j.end()) fail("'" + std::string(key) + "' is missing");
  try {
    read_value(*at, value);
  } catch (std::runtime_error const& e) {
    fail("'" + std::string(key) + "' " + e.what());
  }
}

std::string text_of(TensorFile const& content, char const* key) {
  auto const at = content.metadata.find(key);
  if (at == content.metadata.end()) fail("metadata '" + std::string(key) + "' is missing");
  return at->second;
}

// Calls read(index, entry) for the entries of a list in the metadata; messages name the list and the entry.
template <class Read>
void for_each_entry(TensorFile const& content, char const* key, Read const& read) {
  json list;
  try {
    list = json::parse(text_of(content, key));
  } catch (json::exception const& e) {
    fail("metadata '" + std::string(key) + "' is no JSON: " + e.what());
  }
  if (!list.is_array()) fail("metadata '" + std::string(key) + "' is no list");
  for (std::size_t i = 0; i < list.size(); ++i) {
    try {
      if (!list[i].is_object()) fail("is no JSON object");
      read(i, list[i]);
    } catch (std::exception const& e) {
      fail("metadata '" + std::string(key) + "', entry " + std::to_string(i) + ": " + e.what());
    }
  }
}

FloatTensor const& take(TensorFile const& content, std::string const& name, std::size_t dimensions) {
  auto const at = content.tensor.find(name);
  if (at == content.tensor.end()) fail("tensor '" + name + "' is missing");
  if (at->second.shape.size() != dimensions) fail("tensor '" + name + "' has the wrong number of dimensions");
  return at->second;
}

Mlp read_net(TensorFile const& content, std::size_t k, json const& j, std::size_t& used) {
  Mlp net;
  std::string activation;
  read(j, "activation", activation);
  net.activation = activation_from_string(activation);
  read(j, "parameter", net.parameter);
  for (int l = 0; content.tensor.contains(layer_name(k, l, "weight")); ++l) {
    std::string const name = layer_name(k, l, "weight");
    FloatTensor const& w = take(content, name, 2);
    FloatTensor const& b = take(content, layer_name(k, l, "bias"), 1);
    std::int64_t const out = w.shape[0], in = w.shape[1];
    if (out > 1024 || in > 1024) fail("tensor '" + name + "' is wider than 1024");
    if (l == 0) net.width.push_back(static_cast<int>(in));
    if (in != net.width.back())
      fail("tensor '" + name + "' takes " + std::to_string(in) + " inputs, the layer before gives " +
           std::to_string(net.width.back()));
    net.width.push_back(static_cast<int>(out));
    std::vector<float>& weight = net.weight.emplace_back(w.value.size());  // [in, out]
    for (std::int64_t o = 0; o < out; ++o)
      for (std::int64_t i = 0; i < in; ++i)
        weight[static_cast<std::size_t>(i * out + o)] = w.value[static_cast<std::size_t>(o * in + i)];
    net.bias.push_back(b.value);
    used += 2;
  }
  return net;
}

Shape read_shape(json const& j, Library const& library, FloatTensor const* codes) {
  Shape s;
  s.kind = ShapeKind::net;
  int row = -1;
  read(j, "name", s.name);
  read(j, "net", s.net);
  read(j, "code", row);
  if (s.net < 0 || s.net >= static_cast<int>(library.net.size()))
    fail("'net' is " + std::to_string(s.net) + ", the file has " + std::to_string(library.net.size()) + " networks");
  int const size = library.net[static_cast<std::size_t>(s.net)].code_size();
  if (size > 0) {
    if (!codes || row < 0 || row >= codes->shape[0] || size > codes->shape[1])
      fail("'code' " + std::to_string(row) + " of " + std::to_string(size) + " numbers is not in tensor 'codes'");
    auto const first = codes->value.begin() + row * codes->shape[1];
    s.code.assign(first, first + size);
  }
  read(j, "query_rotation", s.query.rotation);
  read(j, "query_shift", s.query.shift);
  read(j, "query_scale", s.query.scale);
  read(j, "volume", s.volume);
  read(j, "area", s.area);
  read(j, "inertia", s.inertia);
  read(j, "bounding_radius", s.bounding_radius);
  read(j, "box_min", s.box.min);
  read(j, "box_max", s.box.max);
  read(j, "lipschitz", s.lipschitz);
  json const none = json::object();
  json const& certificate = j.contains("certificate") ? j["certificate"] : none;
  if (!certificate.is_object()) fail("'certificate' is no JSON object");
  // Files written before an entry existed stay readable: it was not measured.
  for_each_figure(s.certificate, [&](char const* name, auto& value) {
    if (certificate.contains(name)) read(certificate, name, value);
  });
  return s;
}

}  // namespace

TensorFile tensors_of(Library const& library) {
  TensorFile content;
  json nets = json::array(), shapes = json::array();
  for (std::size_t k = 0; k < library.net.size(); ++k) {
    Mlp const& net = library.net[k];
    nets.push_back({{"activation", to_string(net.activation)}, {"parameter", net.parameter}});
    for (int l = 0; l < net.layers(); ++l) {
      int const in = net.width[l], out = net.width[l + 1];
      FloatTensor weight{{out, in}, {}};
      for (int o = 0; o < out; ++o)
        for (int i = 0; i < in; ++i) weight.value.push_back(net.weight[l][std::size_t(i) * out + o]);
      content.tensor[layer_name(k, l, "weight")] = std::move(weight);
      content.tensor[layer_name(k, l, "bias")] = {{out}, net.bias[l]};
    }
  }
  FloatTensor codes{{0, 0}, {}};
  for (Shape const& s : library.shape) codes.shape[1] = std::max(codes.shape[1], std::int64_t(s.code.size()));
  for (Shape const& s : library.shape) {
    if (!s.is_net()) continue;
    shapes.push_back(to_json(s, s.code.empty() ? -1 : static_cast<int>(codes.shape[0])));
    if (s.code.empty()) continue;
    codes.value.insert(codes.value.end(), s.code.begin(), s.code.end());
    codes.value.resize(static_cast<std::size_t>(++codes.shape[0] * codes.shape[1]));
  }
  if (shapes.empty()) throw std::invalid_argument("has no shape that is a network: there is nothing to exchange");
  if (codes.shape[0] > 0) content.tensor["codes"] = std::move(codes);
  content.metadata = {{"format", format_name}, {"version", format_version}, {"sign", "positive_inside"},
                      {"unit", "d"},           {"nets", nets.dump()},       {"shapes", shapes.dump()}};
  return content;
}

bool is_model_tensors(TensorFile const& content) {
  auto const at = content.metadata.find("format");
  return at != content.metadata.end() && at->second == format_name;
}

Library library_of(TensorFile const& content) {
  if (!is_model_tensors(content)) fail("metadata 'format' is not " + std::string(format_name));
  if (text_of(content, "version") != format_version)
    fail("has version " + text_of(content, "version") + ", this program reads " + format_version);
  if (text_of(content, "sign") != "positive_inside" || text_of(content, "unit") != "d")
    fail("its sign convention or unit is not ours (positive_inside, d)");
  Library library;
  FloatTensor const* const codes = content.tensor.contains("codes") ? &take(content, "codes", 2) : nullptr;
  std::size_t used = codes ? 1 : 0;
  for_each_entry(content, "nets", [&](std::size_t k, json const& j) {
    library.net.push_back(read_net(content, k, j, used));
    for (std::string const& p : problems(library.net.back())) fail(p);
  });
  if (used != content.tensor.size())
    fail("has " + std::to_string(content.tensor.size()) + " tensors, its metadata tells of " + std::to_string(used));
  for_each_entry(content, "shapes",
                 [&](std::size_t, json const& j) { library.shape.push_back(read_shape(j, library, codes)); });
  for (std::string const& p : problems(library)) fail(p);
  return library;
}

std::vector<std::string> false_figures(Library const& library, int threads) {
  std::vector<std::string> found;
  for (Shape const& s : library.shape) {
    auto const wrong = [&](std::string const& what) {
      found.push_back("shape '" + s.name + "': " + what + " is not what its network gives");
    };
    PhiBatch const phi = fast_phi(library, s, threads);
    ZeroSet set;
    try {
      set = find_zero_set(phi, {.radius = 1.1 * s.bounding_radius, .cells = 32});
    } catch (std::runtime_error const&) {
      wrong("bounding_radius");
      continue;
    }
    MeshMass const mass = zero_set_mass(phi, set);
    if (!(std::abs(mass.volume / s.volume - 1) < 0.01)) wrong("volume");
    double radius = 0;
    Box box{set.mesh.vertex.front(), set.mesh.vertex.front()};
    for (Vec3 const& v : set.mesh.vertex) {
      radius = std::max(radius, norm(v));
      for (int k = 0; k < 3; ++k) box.min[k] = std::min(box.min[k], v[k]), box.max[k] = std::max(box.max[k], v[k]);
    }
    if (!(std::abs(radius - s.bounding_radius) < 0.02)) wrong("bounding_radius");
    double off = 0, moment_off = 0;
    for (int k = 0; k < 3; ++k) {
      off = std::max({off, std::abs(box.min[k] - s.box.min[k]), std::abs(box.max[k] - s.box.max[k])});
      moment_off = std::max(moment_off, std::abs(mass.inertia.row[k][k] / s.inertia[k] - 1));
    }
    if (!(off < 0.02)) wrong("box");
    if (!(moment_off < 0.03)) wrong("inertia");
  }
  return found;
}

}  // namespace scree
