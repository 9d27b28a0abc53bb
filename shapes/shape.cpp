// shape.cpp: see shape.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "kernels/sdf/harmonics.h"
#include "shapes/harmonic_shape.h"

namespace scree {
namespace {

struct KindName {
  AnalyticKind kind;
  char const* name;
};
KindName constexpr kind_names[] = {{AnalyticKind::sphere, "sphere"},
                                   {AnalyticKind::ellipsoid, "ellipsoid"},
                                   {AnalyticKind::superellipsoid, "superellipsoid"},
                                   {AnalyticKind::box, "box"}};

// Names become groups of a file: "ballast/0", no empty part, none that means something else there.
bool valid_name(std::string const& name) {
  std::size_t begin = 0;
  while (true) {
    std::size_t const end = std::min(name.find('/', begin), name.size());
    std::string const part = name.substr(begin, end - begin);
    if (part.empty() || part == "." || part == ".." || part == "certificate") return false;
    if (std::any_of(part.begin(), part.end(), [](unsigned char c) { return c < 32 || c == 127; })) return false;
    if (end == name.size()) return true;
    begin = end + 1;
  }
}

bool positive(double v) { return std::isfinite(v) && v > 0; }
bool positive(Vec3 v) { return positive(v.x) && positive(v.y) && positive(v.z); }

bool proper_rotation(Mat3 const& m) {
  Mat3 const product = m * transpose(m);
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(product.row[i][j] - (i == j)));
  // 1e-9: a product of double rotations keeps 1e-15; more is a mistake, not rounding. NaN fails too.
  return worst < 1e-9 && dot(cross(m.row[0], m.row[1]), m.row[2]) > 0;
}

bool finite_figures(Certificate const& c) {
  for (double v : {c.mae, c.p99, c.max, c.band_mae, c.band_p99, c.band_max, c.normal_p50, c.normal_p95,
                   c.flat_normal_p95, c.flat_share, c.hausdorff, c.volume_error, c.inertia_error, c.gradient_p1,
                   c.gradient_p5, c.gradient_p95, c.gradient_p99, c.falling, c.gap})
    if (!std::isfinite(v)) return false;
  return true;
}

void add_query_problems(Shape const& s, std::vector<std::string>& found) {
  if (!positive(s.query.scale) || !is_finite(s.query.shift)) found.push_back("the query transform is not finite");
  if (!proper_rotation(s.query.rotation)) found.push_back("the query transform's rotation is not a proper rotation");
}

void add_net_problems(Library const& library, Shape const& s, std::vector<std::string>& found) {
  if (s.net < 0 || s.net >= static_cast<int>(library.net.size())) {
    found.push_back("network " + std::to_string(s.net) + " does not exist (there are " +
                    std::to_string(library.net.size()) + ")");
    return;
  }
  int const wanted = library.net[s.net].code_size();
  if (static_cast<int>(s.code.size()) != wanted)
    found.push_back("the code has " + std::to_string(s.code.size()) + " numbers, its network takes " +
                    std::to_string(wanted));
  if (std::any_of(s.code.begin(), s.code.end(), [](float v) { return !std::isfinite(v); }))
    found.push_back("the code has a NaN or infinite number");
  add_query_problems(s, found);
}

// Index of a shape's part in a list of the library; reports one that does not exist.
template <class T>
T const* part_of(std::vector<T> const& list, Shape const& s, std::vector<std::string>& found) {
  if (s.data >= 0 && s.data < static_cast<int>(list.size())) return &list[s.data];
  found.push_back(std::string(to_string(s.kind)) + " " + std::to_string(s.data) + " does not exist (there are " +
                  std::to_string(list.size()) + ")");
  return nullptr;
}

std::vector<std::string> harmonics_problems(std::vector<double> const& c) {
  if (harmonic_degree(static_cast<int>(c.size())) < 0 || harmonic_degree(static_cast<int>(c.size())) > 40)
    return {std::to_string(c.size()) + " coefficients: (degree + 1)^2 of a degree of at most 40 are needed"};
  if (std::any_of(c.begin(), c.end(), [](double v) { return !std::isfinite(v); }))
    return {"a coefficient is NaN or infinite"};
  if (!(radius_range(c).least > 0)) return {"the radius is not positive everywhere: the body is not star-shaped"};
  return {};
}

std::vector<std::string> grid_problems(SdfGrid const& g) {
  GridFrame const& f = g.frame;
  if (f.nx < 2 || f.ny < 2 || f.nz < 2 || f.points() != g.value.size())
    return {"its size does not match its values, or is below 2 points"};
  if (!positive(f.cell) || !is_finite(f.origin)) return {"its cell or origin is not finite and positive"};
  if (std::any_of(g.value.begin(), g.value.end(), [](float v) { return !std::isfinite(v); }))
    return {"a value is NaN or infinite"};
  std::size_t i = 0;
  for (int z = 0; z < f.nz; ++z)
    for (int y = 0; y < f.ny; ++y)
      for (int x = 0; x < f.nx; ++x, ++i) {
        bool const face = x == 0 || y == 0 || z == 0 || x == f.nx - 1 || y == f.ny - 1 || z == f.nz - 1;
        if (face && g.value[i] > 0) return {"phi is positive on a face of its box: the box cuts the body"};
      }
  return {};
}

void add_analytic_problems(Shape const& s, std::vector<std::string>& found) {
  AnalyticSdf const& a = s.analytic;
  if (!positive(a.half_size)) found.push_back("half_size must be finite and positive");
  if (a.kind > AnalyticKind::box) found.push_back("a wall is not a grain");
  bool const exponents_ok =
      a.exponent_ns >= 0.1 && a.exponent_ns <= 1.9 && a.exponent_ew >= 0.1 && a.exponent_ew <= 1.9;
  if (a.kind == AnalyticKind::superellipsoid && !exponents_ok) found.push_back("an exponent is outside 0.1..1.9");
}

std::vector<std::string> shape_problems(Library const& library, Shape const& s) {
  std::vector<std::string> found;
  switch (s.kind) {
    case ShapeKind::analytic:
      add_analytic_problems(s, found);
      break;
    case ShapeKind::net:
      add_net_problems(library, s, found);
      break;
    case ShapeKind::harmonics:
      part_of(library.harmonics, s, found);
      add_query_problems(s, found);
      break;
    case ShapeKind::mesh:
      part_of(library.mesh, s, found);
      break;
    case ShapeKind::grid:
      part_of(library.grid, s, found);
      break;
  }
  if (!positive(s.volume)) found.push_back("volume must be finite and positive");
  if (!positive(s.area)) found.push_back("area must be finite and positive");
  if (!positive(s.inertia)) found.push_back("inertia must be finite and positive");
  if (!positive(s.bounding_radius)) found.push_back("bounding radius must be finite and positive");
  if (!is_finite(s.box.min) || !is_finite(s.box.max) || !positive(s.box.max - s.box.min))
    found.push_back("the box is empty or not finite");
  if (!positive(s.lipschitz)) found.push_back("the Lipschitz bound must be finite and positive");
  if (!finite_figures(s.certificate)) found.push_back("the certificate has a NaN or infinite figure");
  return found;
}

}  // namespace

char const* to_string(AnalyticKind kind) {
  for (KindName const& k : kind_names)
    if (k.kind == kind) return k.name;
  throw std::invalid_argument("this AnalyticKind is not a grain");
}

AnalyticKind analytic_kind_from_string(std::string const& name) {
  for (KindName const& k : kind_names)
    if (name == k.name) return k.kind;
  throw std::invalid_argument("unknown shape kind '" + name +
                              "' (net, harmonics, mesh, grid, sphere, ellipsoid, superellipsoid, box)");
}

char const* to_string(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::analytic:
      return "analytic";
    case ShapeKind::net:
      return "net";
    case ShapeKind::harmonics:
      return "harmonics";
    case ShapeKind::mesh:
      return "mesh";
    case ShapeKind::grid:
      return "grid";
  }
  throw std::invalid_argument("this ShapeKind does not exist");
}

std::vector<std::string> problems(Library const& library) {
  std::vector<std::string> found;
  for (std::size_t k = 0; k < library.net.size(); ++k)
    for (std::string const& p : problems(library.net[k])) found.push_back("network " + std::to_string(k) + ": " + p);
  for (std::size_t k = 0; k < library.harmonics.size(); ++k)
    for (std::string const& p : harmonics_problems(library.harmonics[k]))
      found.push_back("harmonics " + std::to_string(k) + ": " + p);
  for (std::size_t k = 0; k < library.mesh.size(); ++k)
    if (!library.mesh[k]) found.push_back("mesh " + std::to_string(k) + " is empty");
  for (std::size_t k = 0; k < library.grid.size(); ++k)
    for (std::string const& p :
         library.grid[k] ? grid_problems(*library.grid[k]) : std::vector<std::string>{"is empty"})
      found.push_back("grid " + std::to_string(k) + ": " + p);
  if (!found.empty()) return found;  // shapes are checked against sound parts
  std::set<std::string> names;
  for (std::size_t i = 0; i < library.shape.size(); ++i) {
    Shape const& s = library.shape[i];
    std::string const label = "shape '" + s.name + "': ";
    if (!valid_name(s.name))
      found.push_back("shape " + std::to_string(i) + ": the name '" + s.name + "' is not allowed");
    if (!names.insert(s.name).second) found.push_back(label + "the name is taken twice");
    for (std::string const& p : shape_problems(library, s)) found.push_back(label + p);
  }
  return found;
}

double evaluate_reference(Library const& library, Shape const& shape, Vec3 x, Vec3* gradient) {
  auto const data = static_cast<std::size_t>(shape.data);
  double phi = 0;
  switch (shape.kind) {
    case ShapeKind::analytic:
      return signed_distance(shape.analytic, x, gradient);
    case ShapeKind::mesh:
      return mesh_distance(library.mesh.at(data)->sdf(), x, gradient);
    case ShapeKind::grid:
      return grid_distance(library.grid.at(data)->frame, library.grid[data]->value, x, gradient);
    case ShapeKind::harmonics:
      phi = radial_distance(library.harmonics.at(data), shape.query(x), gradient);
      break;
    case ShapeKind::net:
      Mlp const& net = library.net.at(static_cast<std::size_t>(shape.net));
      phi = evaluate_reference(net, fold_code(net, shape.code), shape.query(x), gradient);
      break;
  }
  // phi = phi_own / scale and x_own = R (scale x) + shift: the scale cancels in the gradient.
  if (gradient) *gradient = transposed_times(shape.query.rotation, *gradient);
  return phi / shape.query.scale;
}

}  // namespace scree
