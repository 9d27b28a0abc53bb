// terrain_file.cpp: see terrain_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/terrain_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "shapes/mesh_files.h"
#include "shapes/text_lines.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

struct Grid {
  int columns = 0, rows = 0;
  double cell = 0, no_data = -9999;
  std::vector<double> value;  // rows from north to south, as in the file
};

// The one header word this line may be, in lower case; empty: a line of values.
std::string header_word(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (char const* known :
       {"ncols", "nrows", "cellsize", "nodata_value", "xllcorner", "yllcorner", "xllcenter", "yllcenter"})
    if (lower == known) return lower;
  return {};
}

void read_header(std::filesystem::path const& file, int line, std::string const& word, double value, Grid& grid) {
  auto const whole = [&](int& out) {
    if (!(value >= 2 && value <= 1e6) || value != std::floor(value))
      fail_file(file, line, word + " must be a whole number from 2 to 1,000,000");
    out = static_cast<int>(value);
  };
  if (word == "ncols") whole(grid.columns);
  if (word == "nrows") whole(grid.rows);
  if (word == "nodata_value") grid.no_data = value;
  if (word != "cellsize") return;
  if (!(value > 0)) fail_file(file, line, "cellsize must be above 0");
  grid.cell = value;
}

Grid read_grid(std::filesystem::path const& file, std::string const& text) {
  Grid grid;
  int last = 1;
  for_each_line(text, [&](int line, std::vector<std::string_view> const& word) {
    last = line;
    if (std::string const key = header_word(word[0]); !key.empty()) {
      if (word.size() != 2) fail_file(file, line, key + " takes one number");
      if (!grid.value.empty()) fail_file(file, line, key + " stands behind the first values");
      read_header(file, line, key, read_number(file, line, word[1]), grid);
      return;
    }
    if (grid.columns == 0 || grid.rows == 0 || grid.cell == 0)
      fail_file(file, line, "values before ncols, nrows and cellsize were given: is it an ESRI ASCII grid?");
    for (std::string_view const w : word) grid.value.push_back(read_number(file, line, w));
    if (grid.value.size() > std::size_t(grid.columns) * grid.rows)
      fail_file(file, line, "more values than ncols times nrows");
  });
  if (grid.columns == 0 || grid.rows == 0 || grid.cell == 0)
    fail_file(file, "ncols, nrows or cellsize is missing: is it an ESRI ASCII grid?");
  if (std::size_t const wanted = std::size_t(grid.columns) * grid.rows; grid.value.size() != wanted)
    fail_file(file, last,
              std::to_string(grid.value.size()) + " values, but ncols times nrows are " + std::to_string(wanted));
  return grid;
}

}  // namespace

TriangleMesh read_terrain(std::filesystem::path const& file) { return parse_terrain(file, read_whole_file(file)); }

TriangleMesh parse_terrain(std::filesystem::path const& file, std::string const& text) {
  Grid const grid = read_grid(file, text);
  TriangleMesh mesh;
  std::vector<int> vertex(grid.value.size(), -1);
  auto const at = [&](int column, int row) {  // row 0 is the southernmost
    return std::size_t(grid.rows - 1 - row) * grid.columns + column;
  };
  auto const has = [&](std::size_t i) { return grid.value[i] != grid.no_data; };
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c)
      if (std::size_t const i = at(c, r); has(i)) {
        vertex[i] = static_cast<int>(mesh.vertex.size());
        mesh.vertex.push_back({(c + 0.5) * grid.cell, (r + 0.5) * grid.cell, grid.value[i]});
      }
  for (int r = 0; r + 1 < grid.rows; ++r)
    for (int c = 0; c + 1 < grid.columns; ++c) {
      std::size_t const sw = at(c, r), se = at(c + 1, r), nw = at(c, r + 1), ne = at(c + 1, r + 1);
      bool const south = has(sw) && has(se), north = has(nw) && has(ne);
      if (!south || !north) continue;
      int const a = vertex[sw], b = vertex[se], d = vertex[nw], e = vertex[ne];
      if (std::fabs(grid.value[sw] - grid.value[ne]) <= std::fabs(grid.value[se] - grid.value[nw]))
        mesh.triangle.insert(mesh.triangle.end(), {{a, b, e}, {a, e, d}});
      else
        mesh.triangle.insert(mesh.triangle.end(), {{a, b, d}, {b, e, d}});
    }
  check_coordinates(file, mesh);
  if (mesh.triangle.empty()) fail_file(file, "no four neighbouring values have data: there is no surface");
  return mesh;
}

TriangleMesh terrain_ground(TriangleMesh surface) {
  if (surface.triangle.empty()) return surface;
  std::map<std::pair<int, int>, int> uses;  // of an edge in one direction; neighbours run it in opposite ones
  for (auto const& t : surface.triangle)
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  Vec3 low = surface.vertex[surface.triangle[0][0]], high = low;
  for (auto const& t : surface.triangle)
    for (int const v : t)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], surface.vertex[v][k]);
        high[k] = std::max(high[k], surface.vertex[v][k]);
      }
  double const bottom = low.z - std::max(high.x - low.x, high.y - low.y);
  std::map<int, int> foot;  // vertex at the bottom below a vertex of the border
  auto const below = [&](int v) {
    auto const [at, is_new] = foot.try_emplace(v, static_cast<int>(surface.vertex.size()));
    if (is_new) surface.vertex.push_back({surface.vertex[v].x, surface.vertex[v].y, bottom});
    return at->second;
  };
  for (auto const& [edge, n] : uses) {
    auto const [a, b] = edge;
    if (uses.contains({b, a})) continue;
    int const under_a = below(a), under_b = below(b);
    surface.triangle.insert(surface.triangle.end(), {{b, a, under_a}, {b, under_a, under_b}});
  }
  return surface;
}

bool is_terrain_side(Vec3 a, Vec3 b, Vec3 c) {
  auto const above = [](Vec3 p, Vec3 q) { return p.x == q.x && p.y == q.y; };
  return above(a, b) || above(b, c) || above(c, a);
}

}  // namespace scree
