// safetensors_model.h: a library's networks, codes and network shapes as named tensors, and back.
//   net.<k>.<l>.weight [out, in], net.<k>.<l>.bias [out]   as torch.nn.Linear holds them
//   codes [coded shapes, longest code]                     a row's tail beyond its network's code size is zero
//   metadata: format "scree.model", version, sign, unit; JSON texts `nets` (activation, parameter) and `shapes` (name,
//   network, row of codes or -1, query transform, mass, bounds, certificate), both lists in the library's order
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/exchange/safetensors.h"
#include "shapes/shape.h"

namespace scree {

// Shapes that are no networks are left out. Throws std::invalid_argument when none is left.
TensorFile tensors_of(Library const& library);

// The file says that it is one of ours.
bool is_model_tensors(TensorFile const& content);

// The library that tensors_of was given, without the shapes it left out: bit for bit. Everything is judged as a model
// file's content is: std::runtime_error names the tensor, the metadata entry or the shape.
Library library_of(TensorFile const& content);

// What a shape says of its size against its own zero set: volume to 1 %, moments of inertia to 3 %, bounding radius and
// box to 2 % of d. One sentence each that names the shape; empty = it tells the truth. About 0.1 s a shape.
std::vector<std::string> false_figures(Library const& library, int threads = 1);

}  // namespace scree
