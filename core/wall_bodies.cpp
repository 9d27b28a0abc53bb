// wall_bodies.cpp: see wall_bodies.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "shapes/half_thickness.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_report.h"
#include "shapes/point_blocks.h"
#include "shapes/terrain_file.h"
#include "shapes/wall_edges.h"

namespace scree {
namespace {

double constexpr endless = 1e30;  // half an unbounded box [m]: finite, so that turning it gives no NaN
double constexpr infinity = std::numeric_limits<double>::infinity();
double constexpr sharp_angle = std::numbers::pi / 6;
// Nodes along a sharp edge stand this far apart, in the smallest grain's d: as close as a grain's own at 1,000 nodes.
double constexpr edge_spacing = 0.06;

// Rotation that takes z to `axis`.
Quat towards(Vec3 axis) {
  Vec3 const z = normalized(axis), turn = cross({0, 0, 1}, z);
  double const sine = norm(turn), angle = std::atan2(sine, z.z);
  if (!(sine > 0)) return z.z > 0 ? Quat{} : Quat{0, 1, 0, 0};
  return quat_from_rotation_vector(turn * (angle / sine));
}

// Whether it ever has a rate or a velocity. A wall that has none is at rest.
bool moves(MotionCase const& m) {
  auto const fast = [](Vec3 v) { return norm2(v) > 0; };
  if (m.kind == MotionKind::translation)
    return m.time.empty() ? fast(m.velocity) : std::any_of(m.velocities.begin(), m.velocities.end(), fast);
  return m.time.empty() ? m.rate != 0 : std::any_of(m.rates.begin(), m.rates.end(), [](double r) { return r != 0; });
}

struct Builder {
  Case const& c;
  Scene& scene;
  std::vector<std::string>& found;
  std::vector<WallSolid> out;
  double spacing = 0;  // of edge nodes [m]
  int index = 0;       // of the wall

  WallCase const& wall() const { return c.wall[index]; }
  // A motion of no rate is none: the wall is built as one at rest.
  std::optional<MotionCase> motion() const {
    return wall().motion && moves(*wall().motion) ? wall().motion : std::nullopt;
  }

  WallSolid& add(Vec3 position, Quat orientation, AnalyticSdf const& shape, bool bounded) {
    WallSolid s;
    s.body = {index, position, orientation, motion()};
    s.record.analytic = shape;
    s.record.bounding_radius = infinity;
    s.record.box = {{-endless, -endless, -endless}, {endless, endless, endless}};
    if (bounded) {
      for (int k = 0; k < 3; ++k) {
        Vec3 axis;
        axis[k] = 1;
        s.record.box.max[k] = support(shape, axis, nullptr);
        s.record.box.min[k] = -support(shape, -axis, nullptr);
      }
      s.record.bounding_radius = std::max(norm(s.record.box.min), norm(s.record.box.max));
      s.body.reach = s.record.bounding_radius;
    }
    out.push_back(std::move(s));
    return out.back();
  }

  // A half space: a plane record where it rests, a body where it moves.
  void add_plane(Vec3 point, Vec3 normal, double reach) {
    if (!motion()) {
      scene.plane.push_back({point, normalized(normal), material_index(c, wall().material), index});
      return;
    }
    AnalyticSdf plane;
    plane.kind = AnalyticKind::plane;
    add(point, towards(normal), plane, false).body.reach = reach;
  }

  bool is_open(char const* face) const {
    return std::find(wall().open.begin(), wall().open.end(), face) != wall().open.end();
  }

  void add_box() {
    Vec3 const low = wall().min, high = wall().max;
    if (!wall().inside) {
      AnalyticSdf box;
      box.kind = AnalyticKind::box;
      box.half_size = (high - low) * 0.5;
      WallSolid& s = add((low + high) * 0.5, {}, box, true);
      s.record.half_thickness = std::min({box.half_size.x, box.half_size.y, box.half_size.z});
      add_nodes(s, sharp_wall_edges(box_mesh(box.half_size), sharp_angle, false), 0);
      return;
    }
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        std::string const face = std::string(side ? "+" : "-") + "xyz"[axis];
        if (is_open(face.c_str())) continue;
        Vec3 normal;
        normal[axis] = side ? -1 : 1;
        Vec3 point = (low + high) * 0.5;
        if (motion())
          point[axis] = side ? high[axis] : low[axis];
        else
          point = side ? high : low;
        add_plane(point, normal, norm(high - low) / 2);
      }
  }

  static TriangleMesh box_mesh(Vec3 h) {
    TriangleMesh m;
    for (int i = 0; i < 8; ++i) m.vertex.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
    m.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return m;
  }

  // Nodes on the rims of a body of revolution.
  void add_circle(WallSolid& s, double radius, double z) const {
    if (!(radius > 0)) return;
    int const n = std::max(8, static_cast<int>(std::ceil(2 * std::numbers::pi * radius / spacing)));
    for (int i = 0; i < n; ++i) {
      double const angle = 2 * std::numbers::pi * (i + 0.5) / n;
      s.node.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
      s.area.push_back(2 * std::numbers::pi * radius / n * spacing / 2);
    }
  }

  void add_cylinder() {
    Vec3 const axis = wall().to - wall().from, middle = (wall().from + wall().to) * 0.5;
    double const half = norm(axis) / 2, radius = wall().radius, reach = std::hypot(half, radius);
    AnalyticSdf shape;
    shape.half_size = {radius, radius, half};
    if (!wall().inside) {
      shape.kind = AnalyticKind::cylinder;
      WallSolid& s = add(middle, towards(axis), shape, true);
      s.record.half_thickness = std::min(radius, half);
      add_circle(s, radius, -half);
      add_circle(s, radius, half);
      return;
    }
    shape.kind = AnalyticKind::bore;
    add(middle, towards(axis), shape, false).body.reach = reach;
    if (!is_open("from")) add_plane(wall().from, axis, reach);
    if (!is_open("to")) add_plane(wall().to, -axis, reach);
  }

  void add_capsule() {
    AnalyticSdf shape;
    shape.kind = AnalyticKind::capsule;
    shape.half_size = {wall().radius, wall().radius, norm(wall().to - wall().from) / 2};
    add((wall().from + wall().to) * 0.5, towards(wall().to - wall().from), shape, true).record.half_thickness =
        wall().radius;
  }

  void add_cone() {
    Vec3 const axis = wall().to - wall().from;
    double const half = norm(axis) / 2;
    AnalyticSdf shape;
    shape.kind = AnalyticKind::funnel;
    shape.half_size = {wall().radius_from, wall().radius_to, half};
    shape.half_wall = wall().thickness / 2;
    WallSolid& s = add((wall().from + wall().to) * 0.5, towards(axis), shape, true);
    s.record.half_thickness = shape.half_wall;
    // The rims are round, but finer than a grain's nodes.
    double const slope = wall().radius_to - wall().radius_from, length = std::hypot(slope, 2 * half);
    double const out_r = slope / length * shape.half_wall, out_z = 2 * half / length * shape.half_wall;
    add_circle(s, wall().radius_from - out_r, -half - out_z);
    add_circle(s, wall().radius_to + out_r, half + out_z);
  }

  // Nodes along edges; those of a sheet stand on its skin.
  void add_nodes(WallSolid& s, std::vector<WallEdge> const& edges, double half_wall) const {
    EdgePoints const points = points_along(edges, spacing);
    for (std::size_t i = 0; i < points.position.size(); ++i) {
      s.node.push_back(points.position[i] + points.outward[i] * half_wall);
      s.area.push_back(points.length[i] * spacing / 2);
    }
  }

  void add_mesh(TriangleMesh mesh) {
    WallCase const& w = wall();
    bool const terrain = w.kind == WallKind::terrain, sheet = w.thickness > 0;
    for (Vec3& v : mesh.vertex) v = v * w.scale + w.shift;
    if (!terrain && !sheet) {
      if (MeshReport const report = report_mesh(mesh); !report.defects.empty() && !only_inside_out(report)) {
        for (std::string const& defect : report.defects)
          found.push_back(fmt::format("wall '{}': {}: {}. A surface that is open on purpose needs its thickness.",
                                      w.name, w.file.string(), defect));
        return;
      } else if ((report.volume < 0) != w.inside) {
        turn_over(mesh);  // normals point into the free space
      }
    }
    Box box{mesh.vertex[0], mesh.vertex[0]};
    for (Vec3 const& v : mesh.vertex)
      for (int k = 0; k < 3; ++k) box.min[k] = std::min(box.min[k], v[k]), box.max[k] = std::max(box.max[k], v[k]);
    Vec3 const centre = (box.min + box.max) * 0.5, half = (box.max - box.min) * 0.5;
    for (Vec3& v : mesh.vertex) v -= centre;
    WallSolid s;
    s.body = {index, centre, {}, motion(), norm(half) + w.thickness / 2};
    s.record.sdf = SdfKind::mesh;
    s.record.half_wall = w.thickness / 2;
    bool const bounded = sheet || (!terrain && !w.inside);
    Vec3 const reach = bounded ? half + Vec3{1, 1, 1} * s.record.half_wall : Vec3{endless, endless, endless};
    s.record.box = {-reach, reach};
    s.record.bounding_radius = bounded ? norm(reach) : infinity;
    s.mesh = std::make_shared<MeshTree const>(terrain ? terrain_ground(mesh) : mesh, MeshBorder::open);
    if (sheet)
      s.record.half_thickness = s.record.half_wall;
    else if (bounded)
      s.record.half_thickness = thickness_of(*s.mesh, norm(half));
    add_nodes(s, sharp_wall_edges(mesh, sharp_angle, sheet), s.record.half_wall);
    out.push_back(std::move(s));
  }

  // Of a closed solid, from the middles of its triangles inwards.
  static double thickness_of(MeshTree const& tree, double size) {
    int constexpr samples = 200;  // plates down to a hundredth of the solid's size
    std::vector<Vec3> point, normal;
    for (auto const& t : tree.mesh().triangle) {
      Vec3 const a = tree.mesh().vertex[t[0]], b = tree.mesh().vertex[t[1]], c = tree.mesh().vertex[t[2]];
      if (!(norm2(cross(b - a, c - a)) > 0)) continue;
      point.push_back((a + b + c) / 3.0);
      normal.push_back(normalized(cross(b - a, c - a)));
    }
    PhiBatch const phi = [&](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
      for (int i = 0; i < x.size(); ++i) value[i] = mesh_distance(tree.sdf(), x[i], &gradient[i]);
    };
    return half_thickness(phi, point, normal, size / samples, size);
  }

  static bool only_inside_out(MeshReport const& r) {
    return r.open_edges == 0 && r.non_manifold_edges == 0 && r.misoriented_edges == 0 && r.triangles > 0 &&
           r.volume < 0;
  }
  static void turn_over(TriangleMesh& mesh) {
    for (auto& t : mesh.triangle) std::swap(t[1], t[2]);
  }

  void add_file() {
    try {
      add_mesh(wall().kind == WallKind::terrain ? read_terrain(wall().file) : read_mesh(wall().file));
    } catch (std::exception const& e) {
      found.push_back(fmt::format("wall '{}': {}", wall().name, e.what()));
    }
  }
};

// Appends nodes in blocks to the scene's arrays.
void append_nodes(WallSolid const& wall, double spacing, ShapeRecord& record, Scene& scene) {
  PointBlocks const blocks = make_point_blocks(wall.node, nodes_per_block);
  record.first_node = static_cast<int>(scene.node_position.size());
  record.nodes = static_cast<int>(wall.node.size());
  record.first_block = static_cast<int>(scene.block_centre.size());
  record.first_bound = static_cast<int>(scene.block_first.size());
  record.blocks = static_cast<int>(blocks.centre.size());
  record.node_spacing = spacing;
  for (int i : blocks.order) {
    scene.node_position.push_back(wall.node[i]);
    scene.node_area.push_back(wall.area[i]);
  }
  scene.block_centre.insert(scene.block_centre.end(), blocks.centre.begin(), blocks.centre.end());
  scene.block_radius.insert(scene.block_radius.end(), blocks.radius.begin(), blocks.radius.end());
  scene.block_first.insert(scene.block_first.end(), blocks.first.begin(), blocks.first.end());
}

void append_mesh(MeshSdf const& mesh, ShapeRecord& record, Scene& scene) {
  record.first_mesh_node = static_cast<int>(scene.mesh_node.size());
  record.mesh_nodes = mesh.node.size();
  record.first_triangle = static_cast<int>(scene.mesh_corner.size() / 3);
  record.triangles = mesh.corner.size() / 3;
  scene.mesh_node.insert(scene.mesh_node.end(), mesh.node.begin(), mesh.node.end());
  scene.mesh_corner.insert(scene.mesh_corner.end(), mesh.corner.begin(), mesh.corner.end());
  scene.mesh_normal.insert(scene.mesh_normal.end(), mesh.normal.begin(), mesh.normal.end());
}

double node_spacing(Case const& c) {
  double least = infinity;
  for (GrainsCase const& g : c.grains) least = std::min(least, g.least_diameter.value_or(g.diameter));
  return edge_spacing * (std::isfinite(least) ? least : 1);
}

}  // namespace

bool meets_spheres_in_closed_form(ShapeRecord const& wall) {
  AnalyticKind const kind = wall.analytic.kind;
  return wall.sdf == SdfKind::analytic && (kind == AnalyticKind::plane || kind == AnalyticKind::bore ||
                                           kind == AnalyticKind::capsule || kind == AnalyticKind::funnel);
}

int material_index(Case const& c, std::string const& name) {
  for (std::size_t i = 0; i < c.material.size(); ++i)
    if (c.material[i].name == name) return static_cast<int>(i);
  return -1;
}

std::vector<WallSolid> build_walls(Case const& c, Scene& scene, std::vector<std::string>& found) {
  Builder b{c, scene, found, {}, node_spacing(c)};
  for (b.index = 0; b.index < static_cast<int>(c.wall.size()); ++b.index) {
    WallCase const& w = c.wall[b.index];
    switch (w.kind) {
      case WallKind::plane:
        b.add_plane(w.point, w.normal, 0);
        break;
      case WallKind::box:
        b.add_box();
        break;
      case WallKind::cylinder:
        b.add_cylinder();
        break;
      case WallKind::cone:
        b.add_cone();
        break;
      case WallKind::capsule:
        b.add_capsule();
        break;
      case WallKind::mesh:
      case WallKind::terrain:
        b.add_file();
        break;
    }
  }
  // The plan prints the wall nodes; a grain meets them with its own phi (physics.md section 3).
  for (WallSolid const& s : b.out)
    if (!s.node.empty())
      scene.notes.push_back(fmt::format("wall '{}' carries {} nodes on its sharp edges, {:.3g} m apart",
                                        c.wall[s.body.wall].name, s.node.size(), b.spacing));
  return std::move(b.out);
}

void add_wall_bodies(Case const& c, std::vector<WallSolid> const& walls, Scene& scene) {
  double const spacing = node_spacing(c);
  for (WallSolid const& s : walls) {
    ShapeRecord record = s.record;
    if (s.mesh) append_mesh(s.mesh->sdf(), record, scene);
    if (!s.node.empty()) append_nodes(s, spacing, record, scene);
    scene.shape_of.push_back(static_cast<int>(scene.shape.size()));
    scene.shape.push_back(record);
    scene.material_of.push_back(material_index(c, c.wall[s.body.wall].material));
    scene.diameter.push_back(1);
    scene.mass.push_back(infinity);
    scene.inertia.push_back({infinity, infinity, infinity});
    scene.wall.push_back(s.body);
  }
}

}  // namespace scree
