// network_emulator.cpp: the fused device kernel run lane by lane on the host, for tests without a GPU.
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>

#include "kernels/base/profile.h"
#include "kernels/network_device.h"
#include "kernels/sdf/network_image.h"

namespace scree {
namespace {

using namespace sdf_fused;

struct alignas(16) Quad {
  float v[4];
};

struct RunTiles {
  template <template <class> class Act, int W>
  static void run(NetworkClass const& of, Queries const& queries, std::vector<Tile> const& tiles) {
    int const floats = column_floats(W, of.hidden, !queries.gradient.empty());
    std::vector<Quad> store((weight_floats(W) + floats) / 4);
    std::vector<int> ints(shared_ints);
    float* const weight = store.data()->v;
    Networks const networks{of.net, of.weight.data(), of.bias.data()};
    Lanes const block;
    for (Tile const& tile : tiles)
      FusedTile<Lanes, Act, W>(block, networks, queries, tile, weight, weight + weight_floats(W), ints.data())
          .run(gradient_lanes);
  }
};

class EmulatedDevice : public NetworkDevice {
 public:
  std::string describe() const override { return "the device kernel, emulated on the host"; }
  void load(SceneView const& scene, NetworkSet const& networks) override {
    image_ = make_network_image(scene, networks);
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
    for (std::size_t c = 0; c < tiles.size(); ++c)
      dispatch<RunTiles>(image_.classes[c], image_.classes[c], queries, tiles[c]);
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  double kernel_seconds() const override { return seconds_; }

 private:
  NetworkImage image_;
  double seconds_ = 0;
};

}  // namespace

std::unique_ptr<NetworkDevice> make_emulated_network_device() { return std::make_unique<EmulatedDevice>(); }

}  // namespace scree
