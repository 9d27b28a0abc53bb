// case_identity.cpp: see case_identity.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_identity.h"

#include <fmt/format.h>

#include <sstream>
#include <type_traits>
#include <vector>

namespace scree {
namespace {

namespace fs = std::filesystem;

// Fowler, Noll, Vo: 64 bits, byte by byte.
class Fnv1a {
 public:
  void bytes(void const* data, std::size_t count) {
    auto const* byte = static_cast<unsigned char const*>(data);
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ byte[i]) * 0x100000001b3u;
  }
  // Of numbers and of structs of one kind of number: nothing with padding.
  template <class T>
  void number(T const& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_same_v<T, Vec3> || std::is_same_v<T, Quat>);
    bytes(&v, sizeof(v));
  }
  template <class T>
  void array(std::vector<T> const& v) {
    number(v.size());
    for (T const& x : v) number(x);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

// A file is known by its name here, by what is in it in inputs_hash.
fs::path without_folder(fs::path const& file) { return file.empty() ? file : fs::path("/") / file.filename(); }

std::vector<std::string> lines_of(std::string const& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The last table header at or above a line.
std::string table_of(std::vector<std::string> const& lines, std::size_t at) {
  for (std::size_t i = std::min(at + 1, lines.size()); i-- > 0;)
    if (!lines[i].empty() && lines[i][0] == '[') return lines[i] + " ";
  return {};
}

}  // namespace

std::string case_identity(Case const& c) {
  Case same = c;
  same.time.end = 0;
  same.output = {};
  same.checkpoint.reset();
  same.limits.overlap = LimitsCase{}.overlap;
  same.limits.ledger = LimitsCase{}.ledger;
  for (LibraryCase& l : same.library) l.file = without_folder(l.file);
  for (WallCase& w : same.wall) w.file = without_folder(w.file);
  for (GrainsCase& g : same.grains) {
    g.insert.file = without_folder(g.insert.file);
    for (std::string& word : g.shapes)
      if (fs::path const file = mesh_file_of(word); !file.empty()) word = "mesh:" + without_folder(file).string();
  }
  return to_toml(same);
}

std::uint64_t inputs_hash(Case const& c, Scene const& scene) {
  Fnv1a hash;
  for (Mlp const& net : scene.library.net) {
    hash.number(static_cast<int>(net.activation));
    hash.number(net.parameter);
    hash.array(net.width);
    for (auto const& layer : net.weight) hash.array(layer);
    for (auto const& layer : net.bias) hash.array(layer);
  }
  for (Shape const& shape : scene.library.shape) {
    hash.array(std::vector<char>(shape.name.begin(), shape.name.end()));
    hash.array(shape.code);
  }
  hash.array(scene.unique.code);
  hash.array(scene.coefficient);
  hash.array(scene.grid_value);
  hash.array(scene.mesh_corner);
  for (GrainsCase const& g : c.grains) {
    hash.array(g.insert.position);
    hash.array(g.insert.quaternion);
    hash.array(g.insert.velocities);
    hash.array(g.insert.spins);
    hash.array(g.insert.shape);
  }
  return hash.value();
}

std::string first_difference(std::string const& theirs, std::string const& ours) {
  std::vector<std::string> const a = lines_of(theirs), b = lines_of(ours);
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && a[i] == b[i]) ++i;
  if (i == a.size() && i == b.size()) return {};
  auto const line = [&](std::vector<std::string> const& lines) {
    return i < lines.size() ? table_of(lines, i) + (lines[i].empty() || lines[i][0] == '[' ? "" : lines[i])
                            : std::string("nothing more");
  };
  return fmt::format("it has: {}; this case has: {}", line(a), line(b));
}

}  // namespace scree
