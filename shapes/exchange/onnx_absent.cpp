// onnx_absent.cpp: onnx_file.h in a build without ONNX.
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "shapes/exchange/onnx_file.h"

namespace scree {
namespace {

[[noreturn]] void refuse() {
  throw std::runtime_error("this program was built without ONNX: install libonnx-dev, configure with SCREE_ONNX=ON");
}

}  // namespace

bool onnx_available() { return false; }
std::string onnx_model(Library const&, Shape const&) { refuse(); }
std::string onnx_decoder(Library const&, int) { refuse(); }

}  // namespace scree
