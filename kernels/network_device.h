// network_device.h: where batches of network queries run when not on the host: a GPU, or the emulator of its kernel.
// The hybrid mode: every other stage stays on the host, which gathers the surface nodes of all pairs into one batch.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "kernels/base/queue.h"

namespace scree {

struct NetworkSet;
struct QueryBatch;
struct SceneView;
struct WalkBatch;

class NetworkDevice {
 public:
  virtual ~NetworkDevice() = default;

  // One line for logs.
  virtual std::string describe() const = 0;

  // Shapes, sizes and networks of a scene. To be called before evaluate, and again when any of them changes. Throws
  // std::invalid_argument for a network the kernel does not take (more than 8 hidden layers), DeviceError for too
  // little memory or a device built for another chip.
  virtual void load(SceneView const& scene, NetworkSet const& networks) = 0;

  // One launch: phi [partner's d] of all queries of networks, batch.group[0] .. batch.group[networks), and their
  // gradient [body frame] where phi times the partner's diameter exceeds `gradient_from` [m]; the other gradients
  // mean nothing afterwards. -infinity: all gradients; +infinity: none, batch.gradient may then be empty. Same bits as
  // the CPU where its instruction set has a fused multiply-add. Throws DeviceError.
  virtual void evaluate(Queue const& queue, QueryBatch& batch, double gradient_from) = 0;

  // One launch: `most` steps of each walk, walks.group[0] .. walks.group[networks), or fewer where it hits or leaves
  // (see ball_walk.h). Same bits as steps one by one with phi from evaluate. Throws DeviceError.
  virtual void walk(Queue const& queue, WalkBatch& walks, int most) = 0;

  // Time of the kernels of the last evaluate or walk by the device's own clock, without the copies [s]; for benchmarks.
  virtual double kernel_seconds() const = 0;
};

// The kernel on the current CUDA device. Throws DeviceError where there is none.
std::unique_ptr<NetworkDevice> make_cuda_network_device();

// The kernel's own text as a loop over its lanes: the oracle of the device where there is none. Slow.
std::unique_ptr<NetworkDevice> make_emulated_network_device();

}  // namespace scree
