// safetensors.h: named float arrays in one file that Python reads in a line: Hugging Face's safetensors format.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scree {

struct FloatTensor {
  std::vector<std::int64_t> shape;  // row-major; empty: one number
  std::vector<float> value;
};

struct TensorFile {
  std::map<std::string, FloatTensor> tensor;    // by name
  std::map<std::string, std::string> metadata;  // free text of the header's __metadata__
};

// Atomic (temporary name + rename); never overwrites unless `overwrite`. Floats are written as F32, bit for bit, the
// same content always as the same bytes. Throws std::runtime_error naming the file, std::invalid_argument for a tensor
// whose values do not fill its shape.
void write_safetensors(std::filesystem::path const& file, TensorFile const& content, bool overwrite = false);

// F32 as it is; F64, F16 and BF16 rounded to float. Everything is checked before it is used: lengths, JSON, names,
// shapes, offsets (without holes or overlaps, to the end of the file), finite values. Throws std::runtime_error
// "<file>: ..." naming the tensor.
TensorFile read_safetensors(std::filesystem::path const& file);
TensorFile parse_safetensors(std::string const& bytes);  // the same of a file's bytes; messages name no file

}  // namespace scree
