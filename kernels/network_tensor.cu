// network_tensor.cu: the fused network on tensor cores: tensor_tile.h with a CUDA warp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/network_tensor.h"

#include "kernels/cuda_block.h"

namespace scree::sdf_fused {
namespace {

// See tensor_warp.h. Bodies are empty in the host pass, which never runs them, and below sm_80, which lacks m16n8k16.
struct TensorWarp {
  static unsigned constexpr all = 0xffffffffu;

  template <class T>
  struct Own {
    T v;
    SCREE_HD T& operator[](int) { return v; }
    SCREE_HD T const& operator[](int) const { return v; }
  };

  template <class Step>
  SCREE_HD void each(Step const& step) const {
#if defined(__CUDA_ARCH__)
    step(static_cast<int>(threadIdx.x) % warp_lanes);
#endif
  }
  // Not volatile: the compiler may move products past one another.
  SCREE_HD void multiply_16(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const (&a_next)[2],
                            Own<Half2> const& b, Own<Half2> const& b_next) const {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    asm("mma.sync.aligned.m16n8k16.row.col.f32.f16.f16.f32 {%0, %1, %2, %3}, {%4, %5, %6, %7}, {%8, %9}, {%0, %1, %2, "
        "%3};"
        : "+f"(c.v.v[0]), "+f"(c.v.v[1]), "+f"(c.v.v[2]), "+f"(c.v.v[3])
        : "r"(a[0].v), "r"(a[1].v), "r"(a_next[0].v), "r"(a_next[1].v), "r"(b.v), "r"(b_next.v));
#endif
  }
  SCREE_HD void multiply_8(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const& b) const {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
    asm("mma.sync.aligned.m16n8k8.row.col.f32.f16.f16.f32 {%0, %1, %2, %3}, {%4, %5}, {%6}, {%0, %1, %2, %3};"
        : "+f"(c.v.v[0]), "+f"(c.v.v[1]), "+f"(c.v.v[2]), "+f"(c.v.v[3])
        : "r"(a[0].v), "r"(a[1].v), "r"(b.v));
#endif
  }
  template <class T>
  SCREE_HD void from_row(Own<T> const& x, int first, Own<T>& out) const {
#if defined(__CUDA_ARCH__)
    out.v = __shfl_sync(all, x.v, first + fragment_row(static_cast<int>(threadIdx.x) % warp_lanes));
#endif
  }
  // In the order of LoopWarp: neighbours, then pairs.
  SCREE_HD void quad_sum(Own<float>& x) const {
#if defined(__CUDA_ARCH__)
    x.v += __shfl_xor_sync(all, x.v, 1);
    x.v += __shfl_xor_sync(all, x.v, 2);
#endif
  }
  SCREE_HD void to_owner(Own<float> const& x, Own<float>& out) const {
#if defined(__CUDA_ARCH__)
    out.v = __shfl_sync(all, x.v, static_cast<int>(threadIdx.x) % 8 * 4);
#endif
  }
  // Through the read-only path: the compiler then knows that no store changes them.
  static SCREE_HD Pack<2> floats_2(float const* p) {
#if defined(__CUDA_ARCH__)
    float2 const both = __ldg(reinterpret_cast<float2 const*>(p));
    return {{both.x, both.y}};
#else
    return load<2>(p);
#endif
  }
  static SCREE_HD Half2 word(Half2 const* p) {
#if defined(__CUDA_ARCH__)
    return __ldg(p);
#else
    return *p;
#endif
  }
  static SCREE_HD void words_2(Half2 const* p, Half2& first, Half2& second) {
#if defined(__CUDA_ARCH__)
    uint2 const both = __ldg(reinterpret_cast<uint2 const*>(p));
    first = both.x, second = both.y;
#endif
  }
};

struct TensorBlock : ThreadBlock {
  using Warp = TensorWarp;
  template <class Step>
  SCREE_HD void each_warp(Step const& step) const {
#if defined(__CUDA_ARCH__)
    step(TensorWarp{}, static_cast<int>(threadIdx.x) / warp_lanes);
#endif
  }
};

// Blocks a multiprocessor has to hold: 168 registers a lane, but 255 where operands are too wide for that.
template <int W>
int constexpr least_blocks = W <= 40 ? 3 : 2;

template <template <class> class Act, int W, int terms>
__global__ void __launch_bounds__(lanes, least_blocks<W>)
    tensor_kernel(__grid_constant__ const Tensors tensors, __grid_constant__ const Queries queries,
                  Span<const Tile> tiles, int record_floats) {
  extern __shared__ float4 store[];
  float* const record = reinterpret_cast<float*>(store);
  int* const ints = reinterpret_cast<int*>(record + record_floats);
  TensorBlock const block;
  for (int t = static_cast<int>(blockIdx.x); t < tiles.size(); t += static_cast<int>(gridDim.x))
    TensorTile<TensorBlock, Act, W, terms>(block, tensors, queries, tiles[t], record, ints).run();
}

struct LaunchTensors {
  template <template <class> class Act, int W>
  static void run(CudaDevice const& device, cudaStream_t stream, NetworkClass const& of, Tensors const& tensors,
                  Precision precision, Queries const& queries, Span<const Tile> tiles) {
    int const floats = queries.gradient.empty() ? 0 : tensor_warps * record_words<Act, W>(of.hidden);
    std::size_t const bytes = sizeof(float) * floats + sizeof(int) * shared_ints;
    auto const kernel = precision == Precision::fast ? tensor_kernel<Act, W, 1> : tensor_kernel<Act, W, 3>;
    launch_tiles("sdf_net/device", device, stream, kernel, bytes, tiles.size(), tensors, queries, tiles, floats);
  }
};

}  // namespace

void launch_tensor_tiles(CudaDevice const& device, cudaStream_t stream, NetworkClass const& of, Tensors const& tensors,
                         Precision precision, Queries const& queries, Span<const Tile> tiles) {
  if (device.major < 8)
    throw DeviceError(device.name + " has no tensor cores for this kernel (compute capability 8.0): precision fp32");
  dispatch<LaunchTensors>(of, device, stream, of, tensors, precision, queries, tiles);
}

}  // namespace scree::sdf_fused
