// mlp_cpu.h: internals of the CPU batch evaluator: packed network, block job, table of an instruction set.
// Plain data only: the ISA files are compiled with flags the rest of the program must not see, so nothing here may
// pull an inline function of a shared header into them (the linker would keep one copy for everyone).
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace scree::sdf_cpu {

// A network as the kernels read it. Hidden widths are padded to whole panels with zero weights. Activation constants
// are folded into the weights (fold factors: mlp_cpu.cpp). A panel of P neurons is [k][P], panels follow each other.
struct PackedView {
  int hidden = 0;                          // hidden layers, >= 1
  int const* width = nullptr;              // {3, hidden..., 1}
  int const* padded = nullptr;             // the same, hidden widths rounded up to whole panels
  float const* const* forward = nullptr;   // [l < hidden] panels over outputs, k = input
  float const* const* bias = nullptr;      // [l < hidden] padded; entry 0 is unused: the caller's bias rows
  float const* const* backward = nullptr;  // [l < hidden] panels over inputs (l = 0: one panel of 3), k = output
  float const* last_forward = nullptr;     // (padded[hidden]) linear layer
  float const* last_backward = nullptr;    // the same without the activation's fold
  float last_bias = 0;
  float slope = 0;  // leaky_relu only, 0..1
};

// One block of points. Lanes at and beyond `count` are computed on copies of the last point and dropped.
struct BlockJob {
  float const* point = nullptr;      // xyz triples (count)
  int const* row = nullptr;          // bias row of each point (count); nullptr: row 0
  float const* bias_rows = nullptr;  // padded[1] floats a row
  int count = 0;                     // 1..lanes
  float* phi = nullptr;              // (count)
  float* gradient = nullptr;         // xyz triples (count); forward alone ignores it
  float* scratch = nullptr;          // 64-byte aligned, Isa::scratch_rows * lanes floats
};

using BlockFunction = void (*)(PackedView const&, BlockJob const&);

// Indexed by Activation.
struct BlockFunctions {
  BlockFunction forward[3];
  BlockFunction gradient[3];
};

// Kernels of one instruction set.
struct Isa {
  char const* name;
  int size;                  // points a vector
  int vectors;               // of a full block, at most 3
  int panel;                 // neurons a panel
  BlockFunctions blocks[3];  // for blocks of 1 .. vectors vectors

  constexpr int lanes() const { return size * vectors; }  // points of a full block
};

// Scratch a block needs, in rows of `lanes` floats: coordinates or gradient (3), bias of mixed rows, two activation
// buffers, and what the backward pass remembers of every hidden layer.
inline int scratch_rows(int hidden, int widest) { return 3 + widest * (3 + hidden); }

extern Isa const generic_isa;
extern Isa const avx2_isa;    // x86-64 only
extern Isa const avx512_isa;  // x86-64 only

}  // namespace scree::sdf_cpu
