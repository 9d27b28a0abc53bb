// same_library.h: whether two libraries of networks agree in every bit. Their HDF5 files do not: they hold the time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "shapes/shape.h"

namespace scree::test {

template <class T>
std::string bits(std::vector<T> const& v) {
  return {reinterpret_cast<char const*>(v.data()), v.size() * sizeof(T)};
}

// Strings of a shape's numbers and texts, in a fixed order.
inline std::vector<std::string> fields(Shape const& s) {
  Mat3 const& r = s.query.rotation;
  std::vector<Vec3> const vectors{r.row[0], r.row[1], r.row[2], s.query.shift, s.inertia, s.box.min, s.box.max};
  std::vector<double> numbers{s.query.scale, s.volume, s.area, s.bounding_radius, s.lipschitz};
  std::vector<std::string> out{s.name, to_string(s.kind), std::to_string(s.net), bits(s.code), bits(vectors)};
  for_each_figure(s.certificate, [&](char const*, auto const& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
      out.push_back(value);
    else
      numbers.push_back(static_cast<double>(value));
  });
  out.push_back(bits(numbers));
  return out;
}

// Networks and network shapes only. Mismatches are named, not printed: they are bytes.
inline void expect_same(Library const& a, Library const& b) {
  ASSERT_EQ(a.net.size(), b.net.size());
  for (std::size_t k = 0; k < a.net.size(); ++k) {
    EXPECT_EQ(a.net[k].activation, b.net[k].activation);
    EXPECT_EQ(a.net[k].parameter, b.net[k].parameter);
    EXPECT_EQ(a.net[k].width, b.net[k].width);
    ASSERT_EQ(a.net[k].layers(), b.net[k].layers());
    for (int l = 0; l < a.net[k].layers(); ++l) {
      EXPECT_TRUE(bits(a.net[k].weight[l]) == bits(b.net[k].weight[l])) << "network " << k << ", layer " << l;
      EXPECT_TRUE(bits(a.net[k].bias[l]) == bits(b.net[k].bias[l])) << "network " << k << ", layer " << l;
    }
  }
  ASSERT_EQ(a.shape.size(), b.shape.size());
  for (std::size_t i = 0; i < a.shape.size(); ++i)
    EXPECT_TRUE(fields(a.shape[i]) == fields(b.shape[i])) << a.shape[i].name;
}

}  // namespace scree::test
