// report_scene.cpp: see report_scene.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/report_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "core/grain_mesh.h"
#include "core/render_colours.h"
#include "core/surface_export.h"
#include "tools/report_page.h"

namespace scree {
namespace {

std::size_t constexpr most_grains = 20000, most_wall_triangles = 60000;
std::size_t constexpr shape_bytes = 1'500'000;  // of all meshes in the page; a triangle takes some 12

// The grains that are shown: the active ones, evenly thinned.
std::vector<std::size_t> shown_grains(ResultsHeader const& header, Frame const& frame) {
  std::vector<std::size_t> active, out;
  for (std::size_t i = 0; i < header.shape.size(); ++i)
    if (frame.is_active(i)) active.push_back(i);
  for (std::size_t const k : thinned(active.size(), most_grains)) out.push_back(active[k]);
  return out;
}

std::string shape_json(TriangleMesh const& mesh) {
  double largest = 1e-300;
  for (Vec3 const& p : mesh.vertex)
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(p[k]));
  std::vector<std::int16_t> points;
  for (Vec3 const& p : mesh.vertex)
    for (int k = 0; k < 3; ++k) points.push_back(static_cast<std::int16_t>(std::lround(32767 * p[k] / largest)));
  std::vector<std::uint16_t> triangles;
  for (auto const& t : mesh.triangle)
    for (int const corner : t) triangles.push_back(static_cast<std::uint16_t>(corner));
  return fmt::format("{{\"scale\":{:.6g},\"points\":\"{}\",\"triangles\":\"{}\"}}", largest / 32767,
                     base64(points.data(), 2 * points.size()), base64(triangles.data(), 2 * triangles.size()));
}

std::string wall_json(TriangleMesh const& mesh, bool solid) {
  std::vector<float> points;
  for (Vec3 const& p : mesh.vertex)
    for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(p[k]));
  std::vector<std::uint32_t> triangles;
  for (auto const& t : mesh.triangle)
    for (int const corner : t) triangles.push_back(static_cast<std::uint32_t>(corner));
  return fmt::format("{{\"solid\":{},\"points\":\"{}\",\"triangles\":\"{}\"}}", solid,
                     base64(points.data(), 4 * points.size()), base64(triangles.data(), 4 * triangles.size()));
}

// What grains lie on is solid, what stands round them is glass.
bool is_solid(ResultsHeader const& header, std::size_t index) {
  if (index < header.wall.size()) return header.wall[index].normal.z > 0.5;
  ResultsWallBody const& body = header.wall_body[index - header.wall.size()];
  return body.kind == WallSolidKind::terrain ||
         (!body.inside && body.kind != WallSolidKind::bore && body.kind != WallSolidKind::funnel &&
          body.kind != WallSolidKind::sheet);
}

void grow(Box& box, Vec3 p, double by) {
  for (int k = 0; k < 3; ++k)
    box.min[k] = std::min(box.min[k], p[k] - by), box.max[k] = std::max(box.max[k], p[k] + by);
}

}  // namespace

std::string scene_json(ResultsHeader const& header, Frame const& frame, int threads) {
  auto const shown = shown_grains(header, frame);
  std::map<int, int> place;  // of a shape among those shown
  for (std::size_t const i : shown) place.emplace(header.shape[i], static_cast<int>(place.size()));
  std::size_t const each = shape_bytes / (12 * std::max<std::size_t>(place.size(), 1));
  int const triangles = static_cast<int>(std::clamp<std::size_t>(each, 20, 320));
  std::vector<std::string> shapes(place.size());
  for (auto const& [shape, at] : place)
    shapes[at] = shape_json(light_mesh(header.library, header.library.shape[shape], triangles));

  std::vector<double> const overlap = body_values(header, frame, ColourBy::overlap, threads);
  std::map<std::string, int> kinds;
  Box box = empty_box();
  std::string grains;
  for (std::size_t const i : shown) {
    std::string const& name = header.shape_name[header.shape[i]];
    int const kind = kinds.emplace(name.substr(0, name.find('/')), static_cast<int>(kinds.size())).first->second;
    Vec3 const x = frame.position[i];
    Quat const q = frame.orientation[i];
    grow(box, x, 0.5 * header.diameter[i]);
    grains += fmt::format("{}[{},{:.6g},{:.6g},{:.6g},{:.4f},{:.4f},{:.4f},{:.4f},{:.5g},{:.4g},{},{},{:.3g}]",
                          grains.empty() ? "" : ",", place[header.shape[i]], x.x, x.y, x.z, q.w, q.x, q.y, q.z,
                          header.diameter[i], norm(frame.velocity[i]), kind, header.group[i], overlap[i]);
  }

  std::vector<TriangleMesh> const meshes = wall_meshes(header, frame);
  std::size_t wall_triangles = 0, left_out = 0;
  std::string walls;
  for (std::size_t w = 0; w < meshes.size(); ++w) {
    if (meshes[w].triangle.empty()) continue;
    if (wall_triangles + meshes[w].triangle.size() > most_wall_triangles) {
      ++left_out;
      continue;
    }
    wall_triangles += meshes[w].triangle.size();
    walls += (walls.empty() ? "" : ",") + wall_json(meshes[w], is_solid(header, w));
  }
  if (is_empty(box)) box = header.domain;

  std::string note, list;
  std::size_t const bodies = header.shape.size();
  if (shown.size() == most_grains && bodies > most_grains)
    note = fmt::format("{} of {} grains are shown.", most_grains, bodies);
  if (left_out > 0) note += fmt::format(" {} large wall{} left out.", left_out, left_out == 1 ? " is" : "s are");
  for (std::string const& s : shapes) list += (list.empty() ? "" : ",") + s;
  return fmt::format(
      "{{\"shapes\":[{}],\"grains\":[{}],\"walls\":[{}],\"note\":{},\"box\":[{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}]"
      "}}",
      list, grains, walls, json_string(note), box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z);
}

}  // namespace scree
