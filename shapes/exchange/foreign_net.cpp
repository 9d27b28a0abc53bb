// foreign_net.cpp: see foreign_net.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/exchange/foreign_net.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>

namespace scree {
namespace {

[[noreturn]] void fail(std::string const& what) { throw std::runtime_error(what); }

std::string_view constexpr weight_end = "weight", bias_end = "bias";

// Digits are compared as numbers: longer ones are larger.
bool natural_less(std::string const& a, std::string const& b) {
  auto const digits = [](std::string const& s, std::size_t at) {
    std::size_t end = at;
    while (end < s.size() && std::isdigit(static_cast<unsigned char>(s[end]))) ++end;
    return end - at;
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    std::size_t const m = digits(a, i), n = digits(b, j);
    if (m > 0 && n > 0) {
      if (m != n) return m < n;
      if (int const order = a.compare(i, m, b, j, n)) return order < 0;
      i += m, j += n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

// "model.0." of "model.0.weight"; "" and "." are legal.
std::vector<std::string> layers_of(TensorFile const& content) {
  std::vector<std::string> layers;
  for (auto const& [name, tensor] : content.tensor) {
    if (name == "codes") continue;
    bool const weight = name.ends_with(weight_end), bias = name.ends_with(bias_end);
    if (!weight && !bias) fail("tensor '" + name + "' is neither a weight nor a bias nor 'codes'");
    std::string const layer = name.substr(0, name.size() - (weight ? weight_end : bias_end).size());
    std::string const partner = layer + std::string(weight ? bias_end : weight_end);
    if (!content.tensor.contains(partner)) fail("tensor '" + name + "' has no '" + partner + "' beside it");
    if (weight) layers.push_back(layer);
  }
  std::sort(layers.begin(), layers.end(), natural_less);
  return layers;
}

}  // namespace

Mlp net_of(TensorFile const& content, ForeignNet const& convention) {
  Mlp net;
  net.activation = convention.activation;
  net.parameter = convention.parameter;
  for (std::string const& layer : layers_of(content)) {
    std::string const name = layer + std::string(weight_end);
    FloatTensor const& w = content.tensor.at(name);
    FloatTensor const& b = content.tensor.at(layer + std::string(bias_end));
    if (w.shape.size() != 2 || b.shape.size() != 1 || b.shape[0] != w.shape[0])
      fail("tensor '" + name + "' and its bias must be [out, in] and [out]");
    std::int64_t const out = w.shape[0], in = w.shape[1];
    if (out > 1024 || in > 1024) fail("tensor '" + name + "' is wider than 1024");
    if (net.width.empty()) net.width.push_back(static_cast<int>(in));
    if (in != net.width.back())
      fail("tensor '" + name + "' takes " + std::to_string(in) + " inputs, the layer before gives " +
           std::to_string(net.width.back()));
    net.width.push_back(static_cast<int>(out));
    std::vector<float>& weight = net.weight.emplace_back(w.value.size());  // [in, out]
    for (std::int64_t o = 0; o < out; ++o)
      for (std::int64_t i = 0; i < in; ++i)
        weight[static_cast<std::size_t>(i * out + o)] = w.value[static_cast<std::size_t>(o * in + i)];
    net.bias.push_back(b.value);
  }
  if (std::vector<std::string> const found = problems(net); !found.empty()) fail(found.front());
  if (!convention.negative_inside) return net;
  for (float& w : net.weight.back()) w = -w;
  for (float& b : net.bias.back()) b = -b;
  return net;
}

std::vector<std::vector<float>> codes_of(TensorFile const& content, Mlp const& net) {
  auto const at = content.tensor.find("codes");
  if (at == content.tensor.end()) {
    if (net.code_size() == 0) return {{}};
    fail("its network takes a code of " + std::to_string(net.code_size()) + " numbers, there is no tensor 'codes'");
  }
  FloatTensor const& codes = at->second;
  if (codes.shape.size() != 2 || codes.shape[1] != net.code_size() || codes.shape[0] < 1 || net.code_size() == 0)
    fail("tensor 'codes' must be [shapes, " + std::to_string(net.code_size()) + "]: its network takes that many");
  std::vector<std::vector<float>> rows;
  for (auto row = codes.value.begin(); row != codes.value.end(); row += codes.shape[1])
    rows.emplace_back(row, row + codes.shape[1]);
  return rows;
}

}  // namespace scree
