// fuzz_input.h: the bytes of a fuzzer as numbers and texts, in order; behind their end everything is zero or empty.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace scree::fuzz {

class FuzzInput {
 public:
  FuzzInput(std::uint8_t const* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  template <class T>
  T number() {
    T value{};
    std::size_t const n = std::min(sizeof(T), left_);
    if (n > 0) std::memcpy(&value, data_, n);
    data_ += n, left_ -= n;
    return value;
  }
  int byte() { return number<std::uint8_t>(); }
  // 0 ... count - 1; 0 of none.
  std::size_t index(std::size_t count) {
    std::size_t const value = number<std::uint16_t>();
    return count == 0 ? 0 : value % count;
  }
  // A length byte and up to so many characters.
  std::string text() {
    std::size_t const n = std::min<std::size_t>(static_cast<std::size_t>(byte()), left_);
    std::string out(reinterpret_cast<char const*>(data_), n);
    data_ += n, left_ -= n;
    return out;
  }

 private:
  std::uint8_t const* data_;
  std::size_t left_;
};

// What must hold for every input; a fuzzer reports an abort with the input that caused it.
inline void must(bool holds, char const* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace scree::fuzz
