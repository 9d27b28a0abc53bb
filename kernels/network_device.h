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

// Arithmetic of a device. fp32: the CPU's bits. fp16x3: tensor cores, every factor as two halves, within 1e-6 of fp32
// (tests); where only some gradients are wanted, one fp16 pass sorts out the other points. fast: one fp16 pass for all;
// phi errs by about 1e-3 of the ball's radius, leaky ReLU normals by degrees (design: accuracy of phi by precision).
enum class Precision { fp32, fp16x3, fast };
inline char const* to_string(Precision precision) {
  return precision == Precision::fp32 ? "fp32" : precision == Precision::fp16x3 ? "fp16x3" : "fast";
}

class NetworkDevice {
 public:
  virtual ~NetworkDevice() = default;

  // One line for logs.
  virtual std::string describe() const = 0;

  // Shapes, sizes and networks of a scene, and how evaluate computes. To be called before evaluate, and again when any
  // of them changes. Throws std::invalid_argument for a network the kernel does not take (more than 8 hidden layers; in
  // half precision activations near its end), DeviceError for too little memory or a device built for another chip.
  virtual void load(SceneView const& scene, NetworkSet const& networks, Precision precision) = 0;
  void load(SceneView const& scene, NetworkSet const& networks) { load(scene, networks, Precision::fp32); }

  // One launch: phi [partner's d] of all queries of networks, batch.group[0] .. batch.group[networks), and their
  // gradient [body frame] where phi times the partner's diameter exceeds `gradient_from` [m]; the other gradients
  // mean nothing afterwards. -infinity: all gradients; +infinity: none, batch.gradient may then be empty. fp32: same
  // bits as the CPU where its instruction set has a fused multiply-add. fp16x3 with a finite gradient_from: phi below
  // it is an upper bound, so that a node is never taken to be further outside than it is. Throws DeviceError.
  virtual void evaluate(Queue const& queue, QueryBatch& batch, double gradient_from) = 0;

  // One launch: `most` steps of each walk, walks.group[0] .. walks.group[networks), or fewer where it hits or leaves
  // (see ball_walk.h). Always in fp32: same bits as steps one by one with phi from evaluate. Throws DeviceError.
  virtual void walk(Queue const& queue, WalkBatch& walks, int most) = 0;

  // Time of the kernels of the last evaluate or walk by the device's own clock, without the copies [s]; for benchmarks.
  virtual double kernel_seconds() const = 0;
};

// The kernel on the current CUDA device. Throws DeviceError where there is none.
std::unique_ptr<NetworkDevice> make_cuda_network_device();

// The kernel's own text as a loop over its lanes: the oracle of the device where there is none. Slow.
std::unique_ptr<NetworkDevice> make_emulated_network_device();

}  // namespace scree
