// network_image.cpp: see network_image.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/network_image.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "kernels/sdf/mlp_fold.h"

namespace scree::sdf_fused {
namespace {

int padded_width(Mlp const& net) {
  int const widest = *std::max_element(net.width.begin() + 1, net.width.end());
  for (int w : {16, 32, 40, 48})
    if (widest <= w) return w;
  return 64;  // PackedMlp takes no wider ones
}

// The folded weights of one network, as PackedMlp has them, in the order of NetworkRecord.
void append_weights(Mlp const& net, int w, std::vector<float>& out) {
  Fold const fold = fold_of(net);
  int const hidden = net.layers() - 1;
  std::size_t const first = out.size();
  out.resize(first + network_floats(hidden, w), 0.0f);
  float* const forward = out.data() + first;
  float* const bias = forward + std::size_t(hidden) * w * w;
  float* const backward = bias + std::size_t(hidden) * w;
  float* const last_forward = backward + std::size_t(hidden) * w * w;
  float* const last_backward = last_forward + w;
  for (int l = 0; l < hidden; ++l) {
    int const in = l == 0 ? 3 : net.width[l], outputs = net.width[l + 1];
    double const f = l == 0 ? fold.first : fold.middle, b = l == 0 ? fold.backward_first : fold.backward_middle;
    for (int k = 0; k < in; ++k)
      for (int j = 0; j < outputs; ++j) {
        float const weight = net.weight[l][std::size_t(k) * outputs + j];
        forward[(std::size_t(l) * w + k) * w + j] = static_cast<float>(f * weight);
        backward[(std::size_t(l) * w + j) * w + k] = static_cast<float>(b * weight);
      }
    for (int j = 0; j < outputs; ++j) bias[l * w + j] = static_cast<float>(fold.hidden_bias * net.bias[l][j]);
  }
  for (int k = 0; k < net.width[hidden]; ++k) {
    last_forward[k] = static_cast<float>(fold.last * net.weight[hidden][k]);
    last_backward[k] = static_cast<float>(fold.backward_last * net.weight[hidden][k]);
  }
}

NetworkRecord append(PackedMlp const& packed, std::vector<float> const& rows, NetworkClass& to) {
  Mlp const& net = packed.net();
  NetworkRecord record;
  record.hidden = net.layers() - 1;
  record.width[0] = 3;
  std::copy_n(net.width.begin() + 1, record.hidden, record.width + 1);
  record.last_bias = net.bias[record.hidden][0];
  record.slope = static_cast<float>(net.parameter);
  record.first = to.weight.size();
  record.first_bias = to.bias.size();
  append_weights(net, to.width, to.weight);
  int const stride = packed.bias_stride(), count = static_cast<int>(rows.size()) / stride;
  to.bias.resize(record.first_bias + std::size_t(count) * to.width, 0.0f);
  for (int r = 0; r < count; ++r)
    std::copy_n(rows.data() + std::size_t(r) * stride, net.width[1],
                to.bias.data() + record.first_bias + std::size_t(r) * to.width);
  return record;
}

}  // namespace

NetworkImage make_network_image(SceneView const& scene, NetworkSet const& networks) {
  NetworkImage image;
  for (std::size_t i = 0; i < networks.net.size(); ++i) {
    Mlp const& net = networks.net[i].net();
    int const w = padded_width(net), hidden = net.layers() - 1;
    if (hidden > max_hidden)
      throw std::invalid_argument("network " + std::to_string(i) + " has " + std::to_string(hidden) +
                                  " hidden layers; the device takes " + std::to_string(max_hidden));
    auto at = std::find_if(image.classes.begin(), image.classes.end(),
                           [&](NetworkClass const& c) { return c.activation == net.activation && c.width == w; });
    if (at == image.classes.end()) {
      image.classes.push_back({net.activation, w, 0, {}, {}, {}});
      at = image.classes.end() - 1;
    }
    at->hidden = std::max(at->hidden, hidden);
    image.class_of.push_back(static_cast<int>(at - image.classes.begin()));
    image.index_in_class.push_back(static_cast<int>(at->net.size()));
    at->net.push_back(append(networks.net[i], networks.bias_rows[i], *at));
  }
  for (ShapeRecord const& shape : scene.shape) {
    image.frame.push_back(network_frame(shape));
    image.lipschitz.push_back(shape.lipschitz);
  }
  image.shape_of.assign(scene.shape_of.begin(), scene.shape_of.end());
  image.diameter.assign(scene.diameter.begin(), scene.diameter.end());
  image.cohesion_reach = scene.cohesion_reach;
  return image;
}

std::vector<std::vector<Tile>> tiles_of(NetworkImage const& image, Span<const int> group) {
  std::vector<std::vector<Tile>> tiles(image.classes.size());
  for (std::size_t i = 0; i < image.class_of.size(); ++i)
    for (int first = group[i]; first < group[i + 1]; first += tile_points)
      tiles[image.class_of[i]].push_back({image.index_in_class[i], first, std::min(tile_points, group[i + 1] - first)});
  return tiles;
}

}  // namespace scree::sdf_fused
