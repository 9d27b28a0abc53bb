// paraview.cpp: see paraview.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/paraview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/grain_mesh.h"
#include "core/results_walls.h"
#include "core/vtk_file.h"
#include "core/wall_surface.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// value[body] repeated count[body] times.
template <class T>
std::vector<T> repeated(std::vector<T> const& value, std::vector<int> const& count) {
  std::vector<T> out;
  for (std::size_t i = 0; i < value.size(); ++i) out.insert(out.end(), static_cast<std::size_t>(count[i]), value[i]);
  return out;
}

}  // namespace

std::vector<std::int32_t> kind_of_bodies(ResultsHeader const& h) {
  std::map<std::string, int> number;
  std::vector<std::int32_t> of_shape;
  for (std::string const& name : h.shape_name)
    of_shape.push_back(
        number.try_emplace(name.substr(0, name.find_first_of("/:")), static_cast<int>(number.size())).first->second);
  std::vector<std::int32_t> kind;
  for (int const shape : h.shape) kind.push_back(of_shape[static_cast<std::size_t>(shape)]);
  return kind;
}

struct ParaviewWriter::Data {
  struct Entry {
    double time;
    std::string file;
    int part;
  };
  fs::path folder;
  ResultsHeader header;
  std::vector<TriangleMesh> mesh;  // of shape [d]
  std::vector<std::int32_t> body, kind;
  std::vector<int> triangles;  // of body
  int every = 1;               // frames between surfaces
  int frames = 0;
  std::vector<Entry> scene, grains;
  std::optional<Frame> without_surface;  // the last frame, while it has none

  std::vector<VtkArray> body_data(Frame const& frame, std::vector<int> const& count) const;
  void write_walls(fs::path const& file, Frame const* moving) const;
  void write_grains(Frame const& frame);
  void write_surfaces(Frame const& frame);
  void write_collection(char const* name, std::vector<Entry> const& entries) const;
};

// What every body carries, `count[body]` times each.
std::vector<VtkArray> ParaviewWriter::Data::body_data(Frame const& frame, std::vector<int> const& count) const {
  std::vector<Vec3f> velocity;
  for (Vec3 const& v : frame.velocity) velocity.push_back(to_float(v));
  std::vector<VtkArray> out;
  out.push_back(vtk_array("body", repeated(body, count)));
  out.push_back(vtk_array("shape", repeated(header.shape, count)));
  out.push_back(vtk_array("kind", repeated(kind, count)));
  out.push_back(vtk_array("material", repeated(header.material, count)));
  out.push_back(vtk_array("group", repeated(header.group, count)));
  out.push_back(vtk_array("replica", repeated(header.replica, count)));
  out.push_back(vtk_array("velocity", repeated(velocity, count)));
  return out;
}

// Walls at rest, or those that move where they are at `moving`'s time.
void ParaviewWriter::Data::write_walls(fs::path const& file, Frame const* moving) const {
  VtkPolyData data;
  std::vector<std::int32_t> number;
  for (std::size_t w = 0; w < header.wall.size() && !moving; ++w) {
    std::vector<std::int32_t> ring;
    for (Vec3 const& corner : plane_outline(header, static_cast<int>(w))) {
      ring.push_back(static_cast<std::int32_t>(data.point.size()));
      data.point.push_back(to_float(corner));
    }
    if (ring.size() < 3) continue;
    data.ring.push_back(ring);
    number.push_back(static_cast<std::int32_t>(w));
  }
  for (std::size_t w = 0; w < header.wall_body.size(); ++w) {
    if (header.wall_body[w].moving != (moving != nullptr)) continue;
    TriangleMesh const m = posed_wall(header, moving ? *moving : Frame{}, static_cast<int>(w));
    int const first = static_cast<int>(data.point.size());
    for (Vec3 const& v : m.vertex) data.point.push_back(to_float(v));
    for (auto const& t : m.triangle) data.triangle.push_back({first + t[0], first + t[1], first + t[2]});
    number.insert(number.end(), m.triangle.size(), static_cast<std::int32_t>(header.wall.size() + w));
  }
  data.cell_data = {vtk_array("wall", number)};
  write_vtp(file, data);
}

void ParaviewWriter::Data::write_grains(Frame const& frame) {
  VtkPolyData data;
  data.vertices = true;
  std::vector<double> orientation;
  std::vector<int> once;  // inactive bodies are left out
  for (std::size_t i = 0; i < body.size(); ++i) {
    once.push_back(frame.is_active(i));
    if (!once[i]) continue;
    Quat const q = frame.orientation[i];
    data.point.push_back(to_float(frame.position[i]));
    orientation.insert(orientation.end(), {q.w, q.x, q.y, q.z});
  }
  data.point_data = body_data(frame, once);
  data.point_data.push_back(vtk_array("position", repeated(frame.position, once)));
  data.point_data.push_back(vtk_array("spin", repeated(frame.spin, once)));
  data.point_data.push_back(vtk_array("orientation", orientation, 4));
  data.point_data.push_back(vtk_array("diameter", repeated(header.diameter, once)));
  std::string const name = fmt::format("frames/grains_{:05}.vtp", frames);
  write_vtp(folder / name, data);
  grains.push_back({frame.time, name, 0});
  write_collection("grains.pvd", grains);
}

void ParaviewWriter::Data::write_surfaces(Frame const& frame) {
  VtkPolyData data;
  std::vector<int> count = triangles;
  for (std::size_t i = 0; i < body.size(); ++i) {
    if (!frame.is_active(i)) {
      count[i] = 0;
      continue;
    }
    TriangleMesh const& m = mesh[static_cast<std::size_t>(header.shape[i])];
    Mat3 const rotation = to_matrix(frame.orientation[i]);
    int const first = static_cast<int>(data.point.size());
    for (Vec3 const& v : m.vertex)
      data.point.push_back(to_float(frame.position[i] + rotation * v * header.diameter[i]));
    for (std::array<int, 3> const& t : m.triangle) data.triangle.push_back({first + t[0], first + t[1], first + t[2]});
  }
  data.cell_data = body_data(frame, count);
  std::string const name = fmt::format("frames/surfaces_{:05}.vtp", frames);
  write_vtp(folder / name, data);
  scene.push_back({frame.time, name, 0});
  scene.push_back({frame.time, "walls.vtp", 1});
  if (moving_walls(header) > 0) {
    std::string const walls = fmt::format("frames/walls_{:05}.vtp", frames);
    write_walls(folder / walls, &frame);
    scene.push_back({frame.time, walls, 2});
  }
  write_collection("scene.pvd", scene);
}

void ParaviewWriter::Data::write_collection(char const* name, std::vector<Entry> const& entries) const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (Entry const& e : entries)
    text += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" file=\"{}\"/>\n", e.time, e.part, e.file);
  // In one step: a reader never sees half of it.
  replace_whole_file(folder / name, text + "  </Collection>\n</VTKFile>\n");
}

ParaviewWriter::ParaviewWriter(fs::path const& folder, ResultsHeader const& header, ParaviewOptions const& options)
    : data_(std::make_unique<Data>()) {
  Data& d = *data_;
  d.folder = folder;
  d.header = header;
  fs::create_directories(folder / "frames");
  for (Shape const& shape : header.library.shape)
    d.mesh.push_back(light_mesh(header.library, shape, options.triangles));
  d.kind = kind_of_bodies(header);
  double bytes = 0;
  for (std::size_t i = 0; i < header.shape.size(); ++i) {
    TriangleMesh const& m = d.mesh[static_cast<std::size_t>(header.shape[i])];
    d.body.push_back(static_cast<std::int32_t>(i));
    d.triangles.push_back(static_cast<int>(m.triangle.size()));
    bytes += 12.0 * static_cast<double>(m.vertex.size()) + 52.0 * static_cast<double>(m.triangle.size());
  }
  d.every = std::max(1, static_cast<int>(std::ceil(bytes * options.frames_expected / options.surface_budget)));
  d.write_walls(folder / "walls.vtp", nullptr);
}

ParaviewWriter::~ParaviewWriter() = default;

void ParaviewWriter::write_frame(Frame const& frame) {
  Data& d = *data_;
  d.write_grains(frame);
  if (d.frames % d.every == 0)
    d.write_surfaces(frame), d.without_surface.reset();
  else
    d.without_surface = frame;
  ++d.frames;
}

void ParaviewWriter::finish() {
  Data& d = *data_;
  if (!d.without_surface) return;
  --d.frames;  // the number this frame's points have
  d.write_surfaces(*d.without_surface);
  ++d.frames;
  d.without_surface.reset();
}

}  // namespace scree
