// fuzz_safetensors.cpp: safetensors files, and the models in those that say they hold one.
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "shapes/exchange/foreign_net.h"
#include "shapes/exchange/safetensors_model.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/library_target.h"

using namespace scree;

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  try {
    TensorFile const content = parse_safetensors({reinterpret_cast<char const*>(data), size});
    for (auto const& [name, tensor] : content.tensor) {
      std::int64_t count = 1;
      for (std::int64_t const extent : tensor.shape) count *= extent;
      fuzz::must(count == static_cast<std::int64_t>(tensor.value.size()), "values fill their shape");
    }
    if (is_model_tensors(content)) fuzz::check_library(library_of(content));
  } catch (std::runtime_error const&) {
    // a complaint, as it should be
  }
  return 0;
}
