// tensor_emulator.cpp: see tensor_emulator.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/tensor_emulator.h"

namespace scree::sdf_fused {
namespace {

struct RunTensorTiles {
  template <template <class> class Act, int W>
  static void run(NetworkClass const& of, TensorClass const& tensors, Precision precision, Queries const& queries,
                  std::vector<Tile> const& tiles) {
    precision == Precision::fast ? run_all<Act, W, 1>(of, tensors, queries, tiles)
                                 : run_all<Act, W, 3>(of, tensors, queries, tiles);
  }
  template <template <class> class Act, int W, int terms>
  static void run_all(NetworkClass const& of, TensorClass const& tensors, Queries const& queries,
                      std::vector<Tile> const& tiles) {
    std::vector<Pack<4>> record(tensor_warps * record_words<Act, W>(of.hidden) / 4 + 1);
    std::vector<int> ints(shared_ints);
    LoopWarps const block;
    Tensors const view = tensors.view(of);
    for (Tile const& tile : tiles)
      TensorTile<LoopWarps, Act, W, terms>(block, view, queries, tile, record.data()->v, ints.data()).run();
  }
};

}  // namespace

void run_tensor_tiles(NetworkClass const& of, TensorClass const& tensors, Precision precision, Queries const& queries,
                      std::vector<Tile> const& tiles) {
  dispatch<RunTensorTiles>(of, of, tensors, precision, queries, tiles);
}

}  // namespace scree::sdf_fused
