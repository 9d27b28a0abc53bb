// network_emulator.cpp: the fused device kernel run lane by lane on the host, for tests without a GPU.
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>

#include "kernels/base/profile.h"
#include "kernels/network_device.h"
#include "kernels/sdf/network_image.h"
#include "kernels/tensor_emulator.h"
#include "kernels/walk_tile.h"

namespace scree {
namespace {

using namespace sdf_fused;

struct alignas(16) Quad {
  float v[4];
};

// Calls work(weight, column, ints) with the shared storage of a block.
template <int W, class Work>
void with_store(NetworkClass const& of, bool gradient, Work const& work) {
  std::vector<Quad> store((weight_floats(W) + column_floats(W, of.hidden, gradient)) / 4);
  std::vector<int> ints(shared_ints);
  float* const weight = store.data()->v;
  work(weight, weight + weight_floats(W), ints.data());
}

struct RunTiles {
  template <template <class> class Act, int W>
  static void run(NetworkClass const& of, Queries const& queries, std::vector<Tile> const& tiles) {
    Networks const networks{of.net, of.weight.data(), of.bias.data()};
    Lanes const block;
    with_store<W>(of, !queries.gradient.empty(), [&](float* weight, float* column, int* ints) {
      for (Tile const& tile : tiles)
        FusedTile<Lanes, Act, W>(block, networks, queries, tile, weight, column, ints).run(gradient_lanes);
    });
  }
};

struct RunWalks {
  template <template <class> class Act, int W>
  static void run(NetworkClass const& of, Queries const& queries, Walks const& walks, int most,
                  std::vector<Tile> const& tiles) {
    Networks const networks{of.net, of.weight.data(), of.bias.data()};
    Lanes const block;
    with_store<W>(of, false, [&](float* weight, float* column, int* ints) {
      for (Tile const& tile : tiles)
        WalkTile<Lanes, Act, W>(block, networks, queries, walks, tile, weight, column, ints).run(most);
    });
  }
};

class EmulatedDevice : public NetworkDevice {
 public:
  std::string describe() const override { return "the device kernel, emulated on the host"; }
  using NetworkDevice::load;
  void load(SceneView const& scene, NetworkSet const& networks, Precision precision) override {
    image_ = make_network_image(scene, networks);
    precision_ = precision;
    tensors_.clear();
    if (precision != Precision::fp32) tensors_ = make_tensor_image(scene, image_);
  }
  void evaluate(Queue const& queue, QueryBatch& batch, double gradient_from) override {
    ScopedTimer const timer(queue.profile, "sdf_net/device", batch.group[image_.class_of.size()]);
    Queries const queries{image_.frame,
                          image_.shape_of,
                          image_.diameter,
                          image_.cohesion_reach,
                          gradient_from,
                          batch.point,
                          batch.partner,
                          batch.phi,
                          std::isinf(gradient_from) && gradient_from > 0 ? Span<Vec3>() : Span<Vec3>(batch.gradient)};
    auto const start = std::chrono::steady_clock::now();
    auto const tiles = tiles_of(image_, batch.group);
    for (std::size_t c = 0; c < tiles.size(); ++c) {
      NetworkClass const& of = image_.classes[c];
      if (precision_ == Precision::fp32)
        dispatch<RunTiles>(of, of, queries, tiles[c]);
      else
        run_tensor_tiles(of, tensors_[c], precision_, queries, tiles[c]);
    }
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  void walk(Queue const& queue, WalkBatch& batch, int most) override {
    int const n = batch.group[image_.class_of.size()];
    ScopedTimer const timer(queue.profile, "sdf_net/walk", n);
    std::vector<Vec3> point(n);
    std::vector<double> phi(n);
    Queries const queries{image_.frame, image_.shape_of, image_.diameter, image_.cohesion_reach, 0, point, batch.body,
                          phi,          Span<Vec3>()};
    Walks const walks{image_.lipschitz, batch.origin, batch.direction, batch.end, batch.at, batch.step, point};
    auto const start = std::chrono::steady_clock::now();
    auto const tiles = tiles_of(image_, batch.group);
    for (std::size_t c = 0; c < tiles.size(); ++c)
      dispatch<RunWalks>(image_.classes[c], image_.classes[c], queries, walks, most, tiles[c]);
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  double kernel_seconds() const override { return seconds_; }

 private:
  NetworkImage image_;
  Precision precision_ = Precision::fp32;
  std::vector<TensorClass> tensors_;
  double seconds_ = 0;
};

}  // namespace

std::unique_ptr<NetworkDevice> make_emulated_network_device() { return std::make_unique<EmulatedDevice>(); }

}  // namespace scree
