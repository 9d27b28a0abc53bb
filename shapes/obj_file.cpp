// obj_file.cpp: see obj_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/obj_file.h"

#include <charconv>
#include <string_view>
#include <vector>

#include "shapes/text_lines.h"

namespace scree {
namespace {

// Vertex index of "7", "7/1", "7//2" or "-1" (from the end).
int obj_index(std::filesystem::path const& file, int line, std::string_view word, std::size_t vertices) {
  std::string_view const digits = word.substr(0, word.find('/'));
  long index = 0;
  auto const [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || stop != digits.data() + digits.size())
    fail_file(file, line, "not a vertex index: " + std::string(word));
  long const n = static_cast<long>(vertices);
  long const zero_based = index < 0 ? n + index : index - 1;
  if (index == 0 || zero_based < 0 || zero_based >= n)
    fail_file(file, line,
              "vertex " + std::to_string(index) + " does not exist (there are " + std::to_string(n) + " so far)");
  return static_cast<int>(zero_based);
}

}  // namespace

TriangleMesh parse_obj(std::filesystem::path const& file, std::string const& text) {
  TriangleMesh mesh;
  for_each_line(text, [&](int line, std::vector<std::string_view> const& w) {
    if (w[0] == "v") {
      if (w.size() < 4) fail_file(file, line, "a vertex needs three coordinates");
      mesh.vertex.push_back(read_vector(file, line, w, 1));
    } else if (w[0] == "f") {
      if (w.size() < 4) fail_file(file, line, "a face needs three corners");
      std::vector<int> corner;
      for (std::size_t k = 1; k < w.size(); ++k) corner.push_back(obj_index(file, line, w[k], mesh.vertex.size()));
      for (std::size_t k = 2; k < corner.size(); ++k) mesh.triangle.push_back({corner[0], corner[k - 1], corner[k]});
    }  // every other keyword (vn, vt, g, o, s, usemtl ...) says nothing about geometry
  });
  return mesh;
}

std::string obj_text(TriangleMesh const& mesh) {
  std::string text = "# scree mesh\n";
  for (Vec3 v : mesh.vertex) {
    text += 'v';
    append_vector(text, v);
    text += '\n';
  }
  for (auto const& t : mesh.triangle) {
    text += 'f';
    for (int i : t) text.append(1, ' ').append(std::to_string(i + 1));
    text += '\n';
  }
  return text;
}

}  // namespace scree
