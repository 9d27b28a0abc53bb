// mesh_files.cpp: see mesh_files.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_files.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

namespace scree {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
int constexpr stl_header = 84;  // 80 bytes of text and the number of facets
int constexpr stl_facet = 50;   // normal, three corners, two spare bytes

[[noreturn]] void fail(std::filesystem::path const& file, std::string const& what) {
  throw std::runtime_error(file.string() + ": " + what);
}
[[noreturn]] void fail(std::filesystem::path const& file, int line, std::string const& what) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + what);
}

std::string read_all(std::filesystem::path const& file) {
  if (!std::filesystem::exists(file)) fail(file, "no such file");
  if (std::filesystem::is_directory(file)) fail(file, "is a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, "cannot be opened");
  std::string bytes(std::filesystem::file_size(file), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in.gcount() != static_cast<std::streamsize>(bytes.size())) fail(file, "cannot be read");
  return bytes;
}

// Words of one line, without comment.
std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> found;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && std::isspace(static_cast<unsigned char>(line[i]))) ++i;
    std::size_t const begin = i;
    while (i < line.size() && !std::isspace(static_cast<unsigned char>(line[i]))) ++i;
    if (i > begin && line[begin] == '#') break;
    if (i > begin) found.push_back(line.substr(begin, i - begin));
  }
  return found;
}

// Calls visit(line number, words) for each line that has words.
template <class Visit>
void for_each_line(std::string const& text, Visit const& visit) {
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t const end = std::min(text.find('\n', begin), text.size());
    ++number;
    auto const found = words(std::string_view(text).substr(begin, end - begin));
    if (!found.empty()) visit(number, found);
    begin = end + 1;
  }
}

double number(std::filesystem::path const& file, int line, std::string_view word) {
  double value = 0;
  std::string_view const digits = word.front() == '+' ? word.substr(1) : word;
  auto const [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value))
    fail(file, line, "not a finite number: " + std::string(word));
  return value;
}

Vec3 point(std::filesystem::path const& file, int line, std::vector<std::string_view> const& w) {
  if (w.size() < 4) fail(file, line, "a vertex needs three coordinates");
  return {number(file, line, w[1]), number(file, line, w[2]), number(file, line, w[3])};
}

TriangleMesh read_binary_stl(std::filesystem::path const& file, std::string const& bytes, std::uint64_t facets) {
  TriangleMesh soup;
  if (facets > 1u << 28) fail(file, "more than 2^28 facets");
  for (std::uint64_t f = 0; f < facets; ++f) {
    float corner[9];
    std::memcpy(corner, bytes.data() + stl_header + f * stl_facet + 12, sizeof(corner));
    int const first = static_cast<int>(soup.vertex.size());
    for (int k = 0; k < 9; k += 3) soup.vertex.push_back({corner[k], corner[k + 1], corner[k + 2]});
    for (int k = 0; k < 3; ++k)
      if (!is_finite(soup.vertex[first + k])) fail(file, "facet " + std::to_string(f) + ": a coordinate is not finite");
    soup.triangle.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriangleMesh read_ascii_stl(std::filesystem::path const& file, std::string const& text) {
  TriangleMesh soup;
  int corners = 0, last_line = 0;
  bool in_facet = false;
  for_each_line(text, [&](int line, std::vector<std::string_view> const& w) {
    last_line = line;
    if (w[0] == "facet") {
      if (in_facet) fail(file, line, "a facet begins inside a facet");
      in_facet = true;
      corners = 0;
    } else if (w[0] == "vertex") {
      if (!in_facet) fail(file, line, "a vertex outside a facet");
      if (++corners > 3) fail(file, line, "a facet with more than three corners");
      soup.vertex.push_back(point(file, line, w));
    } else if (w[0] == "endfacet") {
      if (!in_facet || corners != 3) fail(file, line, "a facet with " + std::to_string(corners) + " corners");
      in_facet = false;
      int const n = static_cast<int>(soup.vertex.size());
      soup.triangle.push_back({n - 3, n - 2, n - 1});
    } else if (w[0] != "solid" && w[0] != "endsolid" && w[0] != "outer" && w[0] != "endloop") {
      fail(file, line, "unknown word: " + std::string(w[0]));
    }
  });
  if (in_facet) fail(file, last_line, "the file ends inside a facet");
  return soup;
}

TriangleMesh read_stl(std::filesystem::path const& file, std::string const& bytes) {
  // Some binary files begin with "solid" too, so the length decides, and only then the word.
  std::uint32_t facets = 0;
  if (bytes.size() >= stl_header) std::memcpy(&facets, bytes.data() + 80, sizeof(facets));
  std::uint64_t const promised = stl_header + std::uint64_t{facets} * stl_facet;
  if (bytes.size() >= stl_header && bytes.size() == promised) return read_binary_stl(file, bytes, facets);
  if (bytes.rfind("solid", 0) == 0) return read_ascii_stl(file, bytes);
  if (bytes.size() < stl_header) fail(file, "too short for an STL file");
  fail(file, "promises " + std::to_string(facets) + " facets, which are " + std::to_string(promised) +
                 " bytes, but has " + std::to_string(bytes.size()));
}

// Vertex index of "7", "7/1", "7//2" or "-1" (from the end).
int obj_index(std::filesystem::path const& file, int line, std::string_view word, std::size_t vertices) {
  std::string_view const digits = word.substr(0, word.find('/'));
  long index = 0;
  auto const [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || stop != digits.data() + digits.size())
    fail(file, line, "not a vertex index: " + std::string(word));
  long const n = static_cast<long>(vertices);
  long const zero_based = index < 0 ? n + index : index - 1;
  if (index == 0 || zero_based < 0 || zero_based >= n)
    fail(file, line,
         "vertex " + std::to_string(index) + " does not exist (there are " + std::to_string(n) + " so far)");
  return static_cast<int>(zero_based);
}

TriangleMesh read_obj(std::filesystem::path const& file, std::string const& text) {
  TriangleMesh mesh;
  for_each_line(text, [&](int line, std::vector<std::string_view> const& w) {
    if (w[0] == "v") {
      mesh.vertex.push_back(point(file, line, w));
    } else if (w[0] == "f") {
      if (w.size() < 4) fail(file, line, "a face needs three corners");
      std::vector<int> corner;
      for (std::size_t k = 1; k < w.size(); ++k) corner.push_back(obj_index(file, line, w[k], mesh.vertex.size()));
      for (std::size_t k = 2; k < corner.size(); ++k) mesh.triangle.push_back({corner[0], corner[k - 1], corner[k]});
    }  // every other keyword (vn, vt, g, o, s, usemtl ...) says nothing about geometry
  });
  return mesh;
}

std::string lower_extension(std::filesystem::path const& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
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

std::string obj_text(TriangleMesh const& mesh) {
  std::string text = "# scree mesh\n";
  char buffer[32];
  for (Vec3 v : mesh.vertex) {
    text += 'v';
    for (int i = 0; i < 3; ++i) {
      auto const end = std::to_chars(buffer, buffer + sizeof(buffer), v[i]).ptr;  // shortest that reads back the same
      text.append(1, ' ').append(buffer, end);
    }
    text += '\n';
  }
  for (auto const& t : mesh.triangle) {
    text += 'f';
    for (int i : t) text.append(1, ' ').append(std::to_string(i + 1));
    text += '\n';
  }
  return text;
}

struct PointHash {
  std::size_t operator()(Vec3 const& v) const {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) {
      double const plus_zero = v[i] + 0.0;  // -0 equals 0 and must hash alike
      std::uint64_t bits = 0;
      std::memcpy(&bits, &plus_zero, sizeof(bits));
      h = (h ^ bits) * 0x9e3779b97f4a7c15ull;
      h ^= h >> 29;
    }
    return h;
  }
};

}  // namespace

TriangleMesh weld(TriangleMesh const& soup) {
  TriangleMesh mesh;
  std::unordered_map<Vec3, int, PointHash> known;
  std::vector<int> index(soup.vertex.size());
  for (std::size_t i = 0; i < soup.vertex.size(); ++i) {
    auto const [at, fresh] = known.try_emplace(soup.vertex[i], static_cast<int>(mesh.vertex.size()));
    if (fresh) mesh.vertex.push_back(soup.vertex[i]);
    index[i] = at->second;
  }
  for (auto const& t : soup.triangle) {
    std::array<int, 3> const u{index[t[0]], index[t[1]], index[t[2]]};
    if (u[0] != u[1] && u[1] != u[2] && u[2] != u[0]) mesh.triangle.push_back(u);
  }
  return mesh;
}

TriangleMesh read_mesh(std::filesystem::path const& file) {
  std::string const extension = lower_extension(file);
  if (extension != ".stl" && extension != ".obj") fail(file, "unknown mesh format; .stl and .obj are read");
  std::string const bytes = read_all(file);
  TriangleMesh mesh = weld(extension == ".stl" ? read_stl(file, bytes) : read_obj(file, bytes));
  if (mesh.triangle.empty()) fail(file, "has no triangles");
  return mesh;
}

void write_mesh(std::filesystem::path const& file, TriangleMesh const& mesh) {
  std::string const extension = lower_extension(file);
  if (extension != ".stl" && extension != ".obj") fail(file, "unknown mesh format; .stl and .obj are written");
  std::string const bytes = extension == ".stl" ? stl_bytes(mesh) : obj_text(mesh);
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.flush();
  if (!out) fail(file, "cannot be written");
}

}  // namespace scree
