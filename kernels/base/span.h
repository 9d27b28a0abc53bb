// span.h: a pointer and a count that host and device code can both hold.
// std::span's accessors are not usable in device code without relaxed constexpr, hence this one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

#include "kernels/base/config.h"

namespace scree {

template <class T>
struct Span {
  T* data = nullptr;
  int count = 0;

  Span() = default;
  SCREE_HD Span(T* first, int n) : data(first), count(n) {}
  Span(std::vector<std::remove_const_t<T>>& v) : data(v.data()), count(static_cast<int>(v.size())) {}
  template <class U = T>
  requires std::is_const_v<U> Span(std::vector<std::remove_const_t<T>> const& v)
      : data(v.data()), count(static_cast<int>(v.size())) {}
  template <class U>
  requires std::is_same_v<T, U const> SCREE_HD Span(Span<U> other) : data(other.data), count(other.count) {}

  SCREE_HD T& operator[](std::size_t i) const { return data[i]; }
  SCREE_HD int size() const { return count; }
  SCREE_HD bool empty() const { return count == 0; }
  SCREE_HD T* begin() const { return data; }
  SCREE_HD T* end() const { return data + count; }
  SCREE_HD Span subspan(int first, int n) const { return {data + first, n}; }
};

}  // namespace scree
