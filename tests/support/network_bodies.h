// network_bodies.h: bodies without physics whose shapes are given networks, and points in and round them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "kernels/sdf_queries.h"
#include "tests/support/random_mlp.h"

namespace scree::test {

// A scene of bodies without physics: every shape's network, frame and ball.
struct Bodies {
  NetworkSet networks;
  std::vector<ShapeRecord> shape;
  std::vector<int> shape_of;
  std::vector<double> diameter;
  std::vector<std::vector<float>> first_bias;  // of each shape, for evaluate_reference
  double cohesion_reach = 0;

  // One more network with `codes` shapes, each a body of its own.
  void add(Mlp const& net, int codes) {
    networks.net.emplace_back(net);
    networks.bias_rows.emplace_back();
    for (int k = 0; k < codes; ++k) {
      ShapeRecord s;
      s.sdf = SdfKind::net;
      s.net = static_cast<int>(networks.net.size()) - 1;
      first_bias.push_back(fold_code(net, random_code(net.code_size(), 31 * k + shape.size())));
      s.bias_row = networks.net.back().append_bias(first_bias.back(), networks.bias_rows.back());
      s.query_rotation = to_matrix(normalized(Quat{1, 0.1 * k, 0.3, -0.2}));
      s.query_shift = {0.01, -0.02, 0.005 * k};
      s.query_scale = 1.3;
      s.bounding_radius = 0.6;
      shape_of.push_back(static_cast<int>(shape.size()));
      diameter.push_back(0.05 * (1 + k));
      shape.push_back(s);
    }
  }
  SceneView view() const {
    SceneView v;
    v.shape = shape, v.shape_of = shape_of, v.diameter = diameter, v.cohesion_reach = cohesion_reach;
    return v;
  }
  // `each` points in and round the ball of every body, grouped by network.
  QueryBatch queries(int each) const {
    QueryBatch batch;
    batch.group.assign(1, 0);
    auto const points = random_points(each * static_cast<int>(shape_of.size()), 0.7, 5);
    int next = 0;
    for (std::size_t net = 0; net < networks.net.size(); ++net) {
      for (int k = 0; k < each; ++k)  // rows alternate within a tile
        for (std::size_t b = 0; b < shape_of.size(); ++b)
          if (shape[shape_of[b]].net == static_cast<int>(net)) {
            batch.point.push_back(to_double(points[next++]));
            batch.partner.push_back(static_cast<int>(b));
          }
      batch.group.push_back(static_cast<int>(batch.point.size()));
    }
    while (static_cast<int>(batch.group.size()) < query_groups(static_cast<int>(networks.net.size())) + 1)
      batch.group.push_back(static_cast<int>(batch.point.size()));
    batch.phi.assign(batch.point.size(), 77);
    batch.gradient.assign(batch.point.size(), {77, 77, 77});
    return batch;
  }
};

// Each with a usual parameter.
inline std::vector<std::pair<Activation, double>> const activations = {
    {Activation::leaky_relu, 0.01}, {Activation::sine, 5.0}, {Activation::softplus, 20.0}};

inline std::vector<int> widths(int inputs, int hidden, int layers) {
  std::vector<int> w{inputs};
  w.insert(w.end(), layers, hidden);
  w.push_back(1);
  return w;
}

}  // namespace scree::test
