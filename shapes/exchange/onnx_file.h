// onnx_file.h: a network as an ONNX model (opset 13: Gemm, MatMul, Sin, LeakyRelu, Softplus), for any runtime of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "shapes/shape.h"

namespace scree {

// False in a build without ONNX (CMake option SCREE_ONNX); then the functions below throw std::runtime_error.
bool onnx_available();

// One shape as a serialised model: input "x" (points, 3) float [d] in the body frame, output "phi" (points, 1) [d],
// positive inside. Code and query transform are folded into the first layer, in double, rounded once. Metadata: sign,
// unit, frame, shape, bounding_radius [d], certificate figures mae and band_mae where measured. Throws
// std::invalid_argument for a shape that is no network.
std::string onnx_model(Library const& library, Shape const& shape);

// Network `net` of the library as it is, in its own frame and unit: inputs "x" (points, 3) and "code" (1 or points,
// code size), output "phi". Where the code of a shape puts the grain: phi_d(x) = phi(rotation x scale + shift, code) /
// scale, which the metadata entry "shapes" lists as JSON (name, code, rotation, shift, scale). Throws
// std::invalid_argument for a network that takes no code.
std::string onnx_decoder(Library const& library, int net);

}  // namespace scree
