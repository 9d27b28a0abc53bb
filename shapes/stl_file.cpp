// stl_file.cpp: see stl_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/stl_file.h"

#include <bit>
#include <cstdint>
#include <cstring>

#include "shapes/text_lines.h"

namespace scree {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
int constexpr stl_header = 84;  // 80 bytes of text and the number of facets
int constexpr stl_facet = 50;   // normal, three corners, two spare bytes

TriangleMesh parse_binary(std::filesystem::path const& file, std::string const& bytes, std::uint64_t facets) {
  TriangleMesh soup;
  if (facets > 1u << 28) fail_file(file, "more than 2^28 facets");
  for (std::uint64_t f = 0; f < facets; ++f) {
    float corner[9];
    std::memcpy(corner, bytes.data() + stl_header + f * stl_facet + 12, sizeof(corner));
    int const first = static_cast<int>(soup.vertex.size());
    for (int k = 0; k < 9; k += 3) soup.vertex.push_back({corner[k], corner[k + 1], corner[k + 2]});
    for (int k = 0; k < 3; ++k)
      if (!is_finite(soup.vertex[first + k]))
        fail_file(file, "facet " + std::to_string(f) + ": a coordinate is not finite");
    soup.triangle.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh parse_ascii(std::filesystem::path const& file, std::string const& text) {
  TriangleMesh soup;
  int corners = 0, last_line = 0;
  bool in_facet = false, in_solid = false;
  for_each_line(text, [&](int line, std::vector<std::string_view> const& w) {
    last_line = line;
    if (w[0] == "facet") {
      if (in_facet) fail_file(file, line, "a facet begins inside a facet");
      in_facet = true;
      corners = 0;
    } else if (w[0] == "vertex") {
      if (!in_facet) fail_file(file, line, "a vertex outside a facet");
      if (++corners > 3) fail_file(file, line, "a facet with more than three corners");
      if (w.size() < 4) fail_file(file, line, "a vertex needs three coordinates");
      soup.vertex.push_back(read_vector(file, line, w, 1));
    } else if (w[0] == "endfacet") {
      if (!in_facet || corners != 3) fail_file(file, line, "a facet with " + std::to_string(corners) + " corners");
      in_facet = false;
      int const n = static_cast<int>(soup.vertex.size());
      soup.triangle.push_back({n - 3, n - 2, n - 1});
    } else if (w[0] == "solid" || w[0] == "endsolid") {
      in_solid = w[0] == "solid";
    } else if (w[0] != "outer" && w[0] != "endloop") {
      fail_file(file, line, "unknown word: " + std::string(w[0]));
    }
  });
  if (in_facet) fail_file(file, last_line, "the file ends inside a facet");
  if (in_solid) fail_file(file, last_line, "the file ends before endsolid: it is cut short");
  return soup;
}

}  // namespace

TriangleMesh parse_stl(std::filesystem::path const& file, std::string const& bytes) {
  // Some binary files begin with "solid" too, so the length decides, and only then the word.
  std::uint32_t facets = 0;
  if (bytes.size() >= stl_header) std::memcpy(&facets, bytes.data() + 80, sizeof(facets));
  std::uint64_t const promised = stl_header + std::uint64_t{facets} * stl_facet;
  if (bytes.size() >= stl_header && bytes.size() == promised) return parse_binary(file, bytes, facets);
  if (bytes.rfind("solid", 0) == 0) return parse_ascii(file, bytes);
  if (bytes.size() < stl_header) fail_file(file, "too short for an STL file");
  fail_file(file, "promises " + std::to_string(facets) + " facets, which are " + std::to_string(promised) +
                      " bytes, but has " + std::to_string(bytes.size()));
}

std::string stl_bytes(TriangleMesh const& mesh) {
  std::string bytes(stl_header, '\0');
  std::string const title = "scree mesh";  // must not begin with "solid"
  title.copy(bytes.data(), title.size());
  auto const count = static_cast<std::uint32_t>(mesh.triangle.size());
  std::memcpy(bytes.data() + 80, &count, sizeof(count));
  for (auto const& t : mesh.triangle) {
    Vec3 const p = mesh.vertex[t[0]], q = mesh.vertex[t[1]], r = mesh.vertex[t[2]];
    Vec3 const n = cross(q - p, r - p);
    double const length = norm(n);
    Vec3f const row[4] = {to_float(length > 0 ? n / length : Vec3{}), to_float(p), to_float(q), to_float(r)};
    static_assert(sizeof(row) == 48);
    bytes.append(reinterpret_cast<char const*>(row), sizeof(row));
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace scree
