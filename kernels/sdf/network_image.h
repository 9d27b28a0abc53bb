// network_image.h: the networks and shapes of a scene in the layout of the fused device kernel, still on the host.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/sdf/mlp_fused.h"
#include "kernels/sdf_queries.h"

namespace scree::sdf_fused {

// Networks of one activation and padded width share a launch.
struct NetworkClass {
  Activation activation = Activation::leaky_relu;
  int width = 0;   // W: 16, 32, 40, 48 or 64
  int hidden = 0;  // most hidden layers of any
  std::vector<NetworkRecord> net;
  std::vector<float> weight, bias;  // see NetworkRecord
};

struct NetworkImage {
  std::vector<NetworkClass> classes;
  std::vector<int> class_of, index_in_class;  // of each network
  std::vector<NetworkFrame> frame;            // of each shape
  std::vector<int> shape_of;                  // (n_solids)
  std::vector<double> diameter;               // [m] (n_solids)
  std::vector<double> lipschitz;              // of each shape
  double cohesion_reach = 0;                  // [m]
};

// Throws std::invalid_argument naming the network when it has more than max_hidden hidden layers.
NetworkImage make_network_image(SceneView const& scene, NetworkSet const& networks);

// Tiles of each class for queries grouped by network; group: first query of each network, then the end.
std::vector<std::vector<Tile>> tiles_of(NetworkImage const& image, Span<const int> group);

// Calls Run::run<Act, W>(arguments...) for a class's activation and width.
template <class Run, class... Arguments>
void dispatch(NetworkClass const& of, Arguments&&... arguments) {
  auto const with_width = [&]<template <class> class Act>() {
    switch (of.width) {
      case 16:
        return Run::template run<Act, 16>(arguments...);
      case 32:
        return Run::template run<Act, 32>(arguments...);
      case 40:
        return Run::template run<Act, 40>(arguments...);
      case 48:
        return Run::template run<Act, 48>(arguments...);
      default:
        return Run::template run<Act, 64>(arguments...);
    }
  };
  switch (of.activation) {
    case Activation::leaky_relu:
      return with_width.template operator()<sdf_activation::LeakyRelu>();
    case Activation::sine:
      return with_width.template operator()<sdf_activation::Sine>();
    case Activation::softplus:
      return with_width.template operator()<sdf_activation::Softplus>();
  }
}

}  // namespace scree::sdf_fused
