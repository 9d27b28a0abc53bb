// grain_phi.h: phi of the grains of one frame at many points, networks in batches on the host or on a device.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/results.h"
#include "kernels/ball_walk.h"
#include "kernels/sdf_queries.h"
#include "shapes/phi_batch.h"

namespace scree {

// A point to be asked of one body.
struct BodyPoint {
  int body;
  Vec3 point;  // world [m]
};

// The way of a ray through the ball of one body, see kernels/ball_walk.h: lengths in d, body frame.
struct BallWalk {
  int body = -1;
  Vec3 origin, direction;
  double at = 0, end = 0;
  int step = 0;  // steps made, walk_hit or walk_left
};

// Networks are asked as the simulation does, one batch for all the shapes of a decoder; other kinds shape by shape
// through surface_phi, on the host. The bits do not depend on the batch, nor on the device where the host's instruction
// set has a fused multiply-add.
class GrainPhi {
 public:
  // Both references must outlive this. `device`: evaluates the networks; null: the host does. Throws
  // std::invalid_argument when frame and header disagree, and what NetworkDevice::load throws.
  GrainPhi(ResultsHeader const& header, Frame const& frame, std::shared_ptr<NetworkDevice> device);

  // phi [m] and unless null its gradient (world) of each query; points within 1.1 bounding radii of their body. From
  // many threads at once: a device takes their batches one after the other. Throws DeviceError.
  void evaluate(std::vector<BodyPoint> const& queries, std::vector<double>& phi, std::vector<Vec3>* gradient) const;

  // Walks that have not ended go on by one step; on a device those of networks by up to 16 at once.
  void step(std::vector<BallWalk>& walks) const;

  bool on_device() const { return networks_.device != nullptr; }  // some grains are networks, a device evaluates them
  double lipschitz(int body) const { return lipschitz_[header_.shape[body]]; }  // of phi outside the solid
  Vec3 in_body_frame(int body, Vec3 world) const;                               // [d]
  Vec3 turned_to_body(int body, Vec3 direction) const { return transposed_times(rotation_[body], direction); }

 private:
  void place_networks(std::shared_ptr<NetworkDevice> device);
  SceneView view() const;
  // Counting sort by shape, so that neighbours in a network's batch share a code: first item of each place, then the
  // end; the item at each position.
  struct Order {
    std::vector<int> first, item;
  };
  template <class BodyOf>
  Order order_of(std::size_t n, BodyOf const& body_of) const;
  std::vector<int> network_groups(Order const& order) const;  // first item of each network, then the end
  void ask_networks(Order const& order, QueryBatch& batch, bool with_gradient) const;
  void ask_others(Order const& order, QueryBatch& batch, bool with_gradient) const;
  void walk_on_device(Order const& order, std::vector<BallWalk>& walks) const;

  ResultsHeader const& header_;
  Frame const& frame_;
  std::vector<Mat3> rotation_;     // body -> world
  std::vector<double> lipschitz_;  // by shape
  // Shapes in the order of batches: by network, then all without one.
  std::vector<int> shape_at_, place_of_;  // of each place; of each shape
  std::vector<int> first_place_;          // of each network, then of the shapes without one
  std::vector<PhiBatch> other_phi_;       // by shape; empty for networks
  std::vector<ShapeRecord> record_;       // by shape
  NetworkSet networks_;
  mutable std::mutex device_turn_;
};

}  // namespace scree
