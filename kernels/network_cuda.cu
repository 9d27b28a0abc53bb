// network_cuda.cu: the fused network kernel on a CUDA device, and the batches of the hybrid mode; walks of rays.
// SPDX-License-Identifier: Apache-2.0
#include <cuda_runtime.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/base/profile.h"
#include "kernels/cuda_block.h"
#include "kernels/network_device.h"
#include "kernels/network_tensor.h"
#include "kernels/sdf/network_image.h"
#include "kernels/walk_tile.h"

namespace scree {
namespace {

using namespace sdf_fused;

// A block's shared memory: the weights of a layer, its columns (`floats`), then the tile's lists.
struct BlockStore {
  float* weight;
  float* column;
  int* ints;
};
template <int W>
__device__ BlockStore block_store(int floats) {
  extern __shared__ float4 store[];
  float* const weight = reinterpret_cast<float*>(store);
  float* const column = weight + weight_floats(W);
  return {weight, column, reinterpret_cast<int*>(column + floats)};
}

template <template <class> class Act, int W>
__global__ void __launch_bounds__(lanes)
    fused_kernel(__grid_constant__ const Networks networks, __grid_constant__ const Queries queries,
                 Span<const Tile> tiles, int floats, int column_lanes) {
  BlockStore const store = block_store<W>(floats);
  ThreadBlock const block;
  for (int t = static_cast<int>(blockIdx.x); t < tiles.size(); t += static_cast<int>(gridDim.x))
    FusedTile<ThreadBlock, Act, W>(block, networks, queries, tiles[t], store.weight, store.column, store.ints)
        .run(column_lanes);
}

// At most `most` steps of the walks of each tile.
template <template <class> class Act, int W>
__global__ void __launch_bounds__(lanes)
    walk_kernel(__grid_constant__ const Networks networks, __grid_constant__ const Queries queries,
                __grid_constant__ const Walks walks, Span<const Tile> tiles, int floats, int most) {
  BlockStore const store = block_store<W>(floats);
  ThreadBlock const block;
  for (int t = static_cast<int>(blockIdx.x); t < tiles.size(); t += static_cast<int>(gridDim.x))
    WalkTile<ThreadBlock, Act, W>(block, networks, queries, walks, tiles[t], store.weight, store.column, store.ints)
        .run(most);
}

struct ClassOnDevice {
  CudaBuffer<NetworkRecord> net;
  CudaBuffer<float> weight, bias;
  CudaBuffer<Tile> tiles;
  TensorsOnDevice tensors;  // unless in fp32

  Networks networks() const { return {net.span(), weight.data(), bias.data()}; }
};

class CudaNetworks : public NetworkDevice {
 public:
  CudaNetworks() : device_(cuda_device()) {
    check_cuda(cudaStreamCreate(&stream_), "making a stream");
    check_cuda(cudaEventCreate(&before_), "making an event");
    check_cuda(cudaEventCreate(&after_), "making an event");
  }
  ~CudaNetworks() override {
    cudaEventDestroy(before_);
    cudaEventDestroy(after_);
    cudaStreamDestroy(stream_);
  }
  CudaNetworks(CudaNetworks const&) = delete;
  CudaNetworks& operator=(CudaNetworks const&) = delete;

  std::string describe() const override { return scree::describe(device_); }

  using NetworkDevice::load;
  void load(SceneView const& scene, NetworkSet const& networks, Precision precision) override {
    image_ = make_network_image(scene, networks);
    precision_ = precision;
    std::vector<TensorClass> tensors;
    if (precision != Precision::fp32) tensors = make_tensor_image(scene, image_);
    classes_.clear();
    classes_.resize(image_.classes.size());
    for (std::size_t c = 0; c < classes_.size(); ++c) {
      NetworkClass const& from = image_.classes[c];
      classes_[c].net.upload(from.net, stream_);
      classes_[c].weight.upload(from.weight, stream_);
      classes_[c].bias.upload(from.bias, stream_);
      if (!tensors.empty()) classes_[c].tensors.upload(tensors[c], stream_);
    }
    frame_.upload(image_.frame, stream_);
    lipschitz_.upload(image_.lipschitz, stream_);
    shape_of_.upload(image_.shape_of, stream_);
    diameter_.upload(image_.diameter, stream_);
    check_cuda(cudaStreamSynchronize(stream_), "loading networks");
  }

  void evaluate(Queue const& queue, QueryBatch& batch, double gradient_from) override {
    int const n = batch.group[image_.class_of.size()];
    if (n == 0) return;
    ScopedTimer const timer(queue.profile, "sdf_net/device", n);
    bool const with_gradient = !(std::isinf(gradient_from) && gradient_from > 0);
    point_.upload(Span<const Vec3>(batch.point).subspan(0, n), stream_);
    partner_.upload(Span<const int>(batch.partner).subspan(0, n), stream_);
    phi_.resize(n);
    if (with_gradient) gradient_.resize(n);
    Queries const queries{
        frame_.span(),         shape_of_.span(),    diameter_.span(),
        image_.cohesion_reach, gradient_from,       point_.span(),
        partner_.span(),       phi_.mutable_span(), with_gradient ? gradient_.mutable_span() : Span<Vec3>()};
    auto const tiles = tiles_of(image_, batch.group);
    for (std::size_t c = 0; c < tiles.size(); ++c) classes_[c].tiles.upload(tiles[c], stream_);
    check_cuda(cudaEventRecord(before_, stream_), "sdf_net/device");
    for (std::size_t c = 0; c < tiles.size(); ++c) {
      if (tiles[c].empty()) continue;
      NetworkClass const& of = image_.classes[c];
      ClassOnDevice const& data = classes_[c];
      if (precision_ == Precision::fp32)
        dispatch<Launch>(of, *this, of, data, queries);
      else
        launch_tensor_tiles(device_, stream_, of, data.tensors.view(data.bias.data()), precision_, queries,
                            data.tiles.span());
    }
    check_cuda(cudaEventRecord(after_, stream_), "sdf_net/device");
    phi_.download(Span<double>(batch.phi).subspan(0, n), stream_);
    // Gradients nobody asked for come back as they were the step before; nobody reads them.
    if (with_gradient) gradient_.download(Span<Vec3>(batch.gradient).subspan(0, n), stream_);
    check_cuda(cudaStreamSynchronize(stream_), "sdf_net/device");
  }

  void walk(Queue const& queue, WalkBatch& batch, int most) override {
    int const n = batch.group[image_.class_of.size()];
    if (n == 0) return;
    ScopedTimer const timer(queue.profile, "sdf_net/walk", n);
    origin_.upload(Span<const Vec3>(batch.origin).subspan(0, n), stream_);
    direction_.upload(Span<const Vec3>(batch.direction).subspan(0, n), stream_);
    end_.upload(Span<const double>(batch.end).subspan(0, n), stream_);
    partner_.upload(Span<const int>(batch.body).subspan(0, n), stream_);
    at_.upload(Span<const double>(batch.at).subspan(0, n), stream_);
    step_.upload(Span<const int>(batch.step).subspan(0, n), stream_);
    point_.resize(n);
    phi_.resize(n);
    Queries const queries{frame_.span(), shape_of_.span(), diameter_.span(),    image_.cohesion_reach, 0,
                          point_.span(), partner_.span(),  phi_.mutable_span(), Span<Vec3>()};
    Walks const walks{lipschitz_.span(),  origin_.span(),       direction_.span(),    end_.span(),
                      at_.mutable_span(), step_.mutable_span(), point_.mutable_span()};
    auto const tiles = tiles_of(image_, batch.group);
    for (std::size_t c = 0; c < tiles.size(); ++c) classes_[c].tiles.upload(tiles[c], stream_);
    check_cuda(cudaEventRecord(before_, stream_), "sdf_net/walk");
    for (std::size_t c = 0; c < tiles.size(); ++c)
      if (!tiles[c].empty())
        dispatch<LaunchWalks>(image_.classes[c], *this, image_.classes[c], classes_[c], queries, walks, most);
    check_cuda(cudaEventRecord(after_, stream_), "sdf_net/walk");
    at_.download(Span<double>(batch.at).subspan(0, n), stream_);
    step_.download(Span<int>(batch.step).subspan(0, n), stream_);
    check_cuda(cudaStreamSynchronize(stream_), "sdf_net/walk");
  }

  double kernel_seconds() const override {
    float milliseconds = 0;
    check_cuda(cudaEventElapsedTime(&milliseconds, before_, after_), "reading the device's clock");
    return 1e-3 * milliseconds;
  }

 private:
  static std::size_t shared_bytes(int w, int floats) {
    return sizeof(float) * (weight_floats(w) + floats) + sizeof(int) * shared_ints;
  }
  struct Launch {
    template <template <class> class Act, int W>
    static void run(CudaNetworks const& self, NetworkClass const& of, ClassOnDevice const& data,
                    Queries const& queries) {
      int const floats = column_floats(W, of.hidden, !queries.gradient.empty());
      launch_tiles("sdf_net/device", self.device_, self.stream_, fused_kernel<Act, W>, shared_bytes(W, floats),
                   data.tiles.size(), data.networks(), queries, data.tiles.span(), floats, gradient_lanes);
    }
  };
  struct LaunchWalks {
    template <template <class> class Act, int W>
    static void run(CudaNetworks const& self, NetworkClass const& of, ClassOnDevice const& data, Queries const& queries,
                    Walks const& walks, int most) {
      int const floats = column_floats(W, of.hidden, false);
      launch_tiles("sdf_net/walk", self.device_, self.stream_, walk_kernel<Act, W>, shared_bytes(W, floats),
                   data.tiles.size(), data.networks(), queries, walks, data.tiles.span(), floats, most);
    }
  };

  CudaDevice device_;
  cudaStream_t stream_ = nullptr;
  cudaEvent_t before_ = nullptr, after_ = nullptr;
  NetworkImage image_;
  Precision precision_ = Precision::fp32;
  std::vector<ClassOnDevice> classes_;
  CudaBuffer<NetworkFrame> frame_;
  CudaBuffer<int> shape_of_, partner_, step_;
  CudaBuffer<double> diameter_, lipschitz_, phi_, end_, at_;
  CudaBuffer<Vec3> point_, gradient_, origin_, direction_;
};

}  // namespace

std::unique_ptr<NetworkDevice> make_cuda_network_device() { return std::make_unique<CudaNetworks>(); }

}  // namespace scree
