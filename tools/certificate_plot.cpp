// certificate_plot.cpp: see certificate_plot.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/certificate_plot.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/mesh/sharp_edges.h"
#include "shapes/zero_set.h"
#include "tools/plot_script.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

int constexpr slice_points = 141;  // along each side of a slice
int constexpr samples = 20000;     // of |grad phi| and of normals
double constexpr edge_angle = std::numbers::pi / 6;

fs::path part_file(fs::path const& picture, char const* part) {
  return picture.parent_path() / (picture.stem().string() + "-" + part + ".csv");
}

// A CSV file beside the picture.
class Table {
 public:
  Table(fs::path const& picture, char const* part, char const* header) : path_(part_file(picture, part)), out_(path_) {
    out_ << header << '\n';
  }
  void row(std::string const& line) { out_ << line << '\n'; }
  void close() {
    out_.close();
    if (!out_) throw std::runtime_error(path_.string() + ": cannot be written");
  }

 private:
  fs::path path_;
  std::ofstream out_;
};

// The plane x_axis = 0 is drawn with u and v the next two axes in turn.
int u_axis(int axis) { return (axis + 1) % 3; }
int v_axis(int axis) { return (axis + 2) % 3; }

void write_slices(PhiBatch const& phi, double half, fs::path const& picture) {
  Table table(picture, "slices", "axis,u,v,phi");
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3> point;
    for (int j = 0; j < slice_points; ++j)
      for (int i = 0; i < slice_points; ++i) {
        Vec3& x = point.emplace_back();
        x[u_axis(axis)] = half * (2.0 * i / (slice_points - 1) - 1);
        x[v_axis(axis)] = half * (2.0 * j / (slice_points - 1) - 1);
      }
    std::vector<double> value(point.size());
    phi(point, value, {});
    for (std::size_t i = 0; i < point.size(); ++i)
      table.row(fmt::format("{},{:.5f},{:.5f},{:.6f}", axis, point[i][u_axis(axis)], point[i][v_axis(axis)], value[i]));
  }
  table.close();
}

// Where the triangles of the truth cut the three planes.
void write_outline(MeshTruth const* truth, fs::path const& picture) {
  Table table(picture, "outline", "axis,u0,v0,u1,v1");
  if (truth) {
    std::vector<Vec3> vertex;
    for (Vec3 const& x : truth->mesh().vertex) vertex.push_back(truth->alignment().frame.to_shape(x));
    for (int axis = 0; axis < 3; ++axis)
      for (auto const& t : truth->mesh().triangle) {
        std::vector<Vec3> cut;
        for (int k = 0; k < 3; ++k) {
          Vec3 const a = vertex[t[k]], b = vertex[t[(k + 1) % 3]];
          if ((a[axis] < 0) != (b[axis] < 0)) cut.push_back(a + (b - a) * (a[axis] / (a[axis] - b[axis])));
        }
        if (cut.size() == 2)
          table.row(fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f}", axis, cut[0][u_axis(axis)], cut[0][v_axis(axis)],
                                cut[1][u_axis(axis)], cut[1][v_axis(axis)]));
      }
  }
  table.close();
}

void write_slopes(PhiBatch const& phi, double radius, Table& table) {
  ZeroSetOptions options;
  options.radius = radius;
  ZeroSet const set = find_zero_set(phi, options);
  SurfacePoints surface = surface_points(set.mesh, samples);
  std::vector<double> value(surface.position.size());
  std::vector<Vec3> gradient(value.size());
  for (std::size_t i = 0; i < value.size(); ++i)  // the golden ratio spreads the depths evenly
    surface.position[i] +=
        surface.normal[i] * (contact_band * (2 * std::fmod(static_cast<double>(i) * 0.6180339887498949, 1.0) - 1));
  phi(surface.position, value, gradient);
  for (Vec3 const& g : gradient) table.row(fmt::format("slope,{:.5f}", norm(g)));
}

void write_normals(PhiBatch const& phi, MeshTruth const& truth, Table& table) {
  BodyFrame const& frame = truth.alignment().frame;
  SurfacePoints const surface = surface_points(truth.mesh(), samples);
  SegmentDistance const edge(sharp_edges(truth.mesh(), edge_angle));
  std::vector<Vec3> point;
  for (Vec3 const& x : surface.position) point.push_back(frame.to_shape(x));
  std::vector<double> value(point.size());
  std::vector<Vec3> gradient(point.size());
  phi(point, value, gradient);
  for (std::size_t i = 0; i < point.size(); ++i) {
    Vec3 const inward = frame.rotation * -surface.normal[i];
    double const angle = std::atan2(norm(cross(gradient[i], inward)), dot(gradient[i], inward));
    bool const flat = edge(surface.position[i]) > 0.03 * frame.scale;
    table.row(fmt::format("{},{:.4f}", flat ? "flat" : "edge", angle * 180 / std::numbers::pi));
  }
}

std::string title(Shape const& shape, MeshTruth const* truth) {
  Certificate const& c = shape.certificate;
  auto const figure = [](double v) { return v < 0 ? std::string("-") : fmt::format("{:.1e}", v); };
  std::string text = fmt::format("{}: shell MAE {} d, band MAE {} d, Hausdorff {} d", shape.name, figure(c.mae),
                                 figure(c.band_mae), figure(c.hausdorff));
  if (truth) text += fmt::format(", volume {}, inertia {}", figure(c.volume_error), figure(c.inertia_error));
  return text;
}

}  // namespace

std::vector<fs::path> plot_files(fs::path const& picture) {
  return {picture, part_file(picture, "slices"), part_file(picture, "outline"), part_file(picture, "samples")};
}

std::string plot_certificate(Library const& library, Shape const& shape, MeshTruth const* truth,
                             fs::path const& picture, int threads) {
  PhiBatch const phi = fast_phi(library, shape, threads);
  write_slices(phi, 1.1 * shape.bounding_radius, picture);
  write_outline(truth, picture);
  Table table(picture, "samples", "kind,value");
  write_slopes(phi, 1.1 * shape.bounding_radius, table);
  if (truth) write_normals(phi, *truth, table);
  table.close();
  return run_plot_script(plot_certificate_text, {picture.string(), title(shape, truth)});
}

}  // namespace scree
