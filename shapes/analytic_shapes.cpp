// analytic_shapes.cpp: volumes and inertias of superellipsoids after Jaklic, Leonardis, Solina, "Segmentation and
// Recovery of Superquadrics" (2000), section 2.4, with their (e1, e2) = (ns, ew); ellipsoid and sphere are e1 = e2 = 1.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/analytic_shapes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace scree {
namespace {

double beta(double x, double y) { return std::exp(std::lgamma(x) + std::lgamma(y) - std::lgamma(x + y)); }

double superellipsoid_volume(Vec3 a, double e1, double e2) {
  return 2 * a.x * a.y * a.z * e1 * e2 * beta(e1 / 2 + 1, e1) * beta(e2 / 2, e2 / 2);
}

Vec3 superellipsoid_inertia(Vec3 a, double e1, double e2) {
  double const half_abc = 0.5 * a.x * a.y * a.z * e1 * e2;
  double const in_plane = beta(1.5 * e2, 0.5 * e2) * beta(0.5 * e1, 2 * e1 + 1);   // times a^2: integral of x^2
  double const axial = 4 * beta(0.5 * e2, 0.5 * e2 + 1) * beta(1.5 * e1, e1 + 1);  // times c^2: integral of z^2
  double const xx = a.x * a.x * in_plane, yy = a.y * a.y * in_plane, zz = a.z * a.z * axial;
  return Vec3{yy + zz, xx + zz, xx + yy} * half_abc;
}

// Largest |s|: max of (A^2 X^2 + B^2 Y^2) over X^p + Y^p = 1 is the dual norm, r = 2p/(p-2), for p > 2 and a corner of
// the (p <= 2) unit ball else. First in the x-y section, then against z.
double longest(double a, double b, double p) {
  if (p <= 2 + 1e-12) return std::max(a, b);
  double const r = 2 * p / (p - 2), m = std::max(a, b);
  return m * std::pow(std::pow(a / m, r) + std::pow(b / m, r), 1 / r);
}

// Area of the inscribed triangulation of one octant on Barr's angles, times 8. Second order in the angle, and the
// angles crowd where the surface bends: 400 of them leave 1e-5.
double superellipsoid_area(Vec3 a, double e1, double e2) {
  int constexpr n = 400;
  auto const table = [](double exponent, bool sine) {
    std::vector<double> value(n + 1);
    for (int i = 0; i <= n; ++i) {
      double const angle = std::numbers::pi / 2 * (sine ? i : n - i) / n;
      value[i] = i == (sine ? 0 : n) ? 0 : std::pow(std::sin(angle), exponent);
    }
    return value;
  };
  std::vector<double> const c1 = table(e1, false), s1 = table(e1, true), c2 = table(e2, false), s2 = table(e2, true);
  auto const point = [&](int i, int j) { return Vec3{a.x * c1[i] * c2[j], a.y * c1[i] * s2[j], a.z * s1[i]}; };
  double area = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Vec3 const p00 = point(i, j), p10 = point(i + 1, j), p01 = point(i, j + 1), p11 = point(i + 1, j + 1);
      area += 0.5 * (norm(cross(p10 - p00, p11 - p00)) + norm(cross(p11 - p00, p01 - p00)));
    }
  return 8 * area;
}

void require_axes(char const* kind, Vec3 axes) {
  double const low = std::min({axes.x, axes.y, axes.z}), high = std::max({axes.x, axes.y, axes.z});
  if (!is_finite(axes) || !(low > 0) || high > 100 * low)
    throw std::invalid_argument(std::string(kind) + ": axes must be positive and within a ratio of 100");
}

Shape analytic(AnalyticKind kind, Vec3 half_size, Vec3 inertia, double area, double radius) {
  Shape s;
  s.name = to_string(kind);
  s.analytic.kind = kind;
  s.analytic.half_size = half_size;
  s.inertia = inertia;
  s.area = area;
  s.bounding_radius = radius;
  s.box = {-half_size, half_size};
  s.lipschitz = 1;  // true distances
  s.certificate.components = 1;
  s.certificate.source = s.name;
  return s;
}

char constexpr forms[] =
    R"("sphere", "ellipsoid:1:0.8:0.6", "superellipsoid:1:0.8:0.6:0.5" (or ...:ns:ew), "box:1:1:1")";

[[noreturn]] void refuse(std::string const& spec, std::string const& why) {
  throw std::invalid_argument("shape '" + spec + "': " + why + "; allowed are " + forms);
}

std::vector<double> numbers_after_kind(std::string const& spec) {
  std::vector<double> values;
  for (std::size_t colon = spec.find(':'); colon != std::string::npos;) {
    std::size_t const end = std::min(spec.find(':', colon + 1), spec.size());
    double value = 0;
    auto const [stop, error] = std::from_chars(spec.data() + colon + 1, spec.data() + end, value);
    if (error != std::errc() || stop != spec.data() + end)
      refuse(spec, std::string("not a number: ").append(spec, colon + 1, end - colon - 1));
    values.push_back(value);
    colon = end == spec.size() ? std::string::npos : end;
  }
  return values;
}

Shape from_numbers(std::string const& spec, AnalyticKind kind, std::vector<double> const& v) {
  auto const want = [&](bool ok, char const* text) {
    if (!ok) refuse(spec, "it takes " + std::string(text));
  };
  switch (kind) {
    case AnalyticKind::sphere:
      want(v.empty(), "no numbers");
      return make_sphere();
    case AnalyticKind::ellipsoid:
      want(v.size() == 3, "three axes");
      return make_ellipsoid({v[0], v[1], v[2]});
    case AnalyticKind::superellipsoid:
      want(v.size() == 4 || v.size() == 5, "three axes and one or two exponents");
      return make_superellipsoid({v[0], v[1], v[2]}, v[3], v.back());
    case AnalyticKind::box:
      want(v.size() == 3, "three edges");
      return make_box({v[0], v[1], v[2]});
    default:
      refuse(spec, "it is a wall, not a grain");
  }
}

}  // namespace

Shape make_sphere() {
  double constexpr volume = std::numbers::pi / 6;
  return analytic(AnalyticKind::sphere, {0.5, 0.5, 0.5}, Vec3{1, 1, 1} * (0.1 * volume), std::numbers::pi, 0.5);
}

Shape make_ellipsoid(Vec3 axes) {
  require_axes("ellipsoid", axes);
  Vec3 const a = axes * (0.5 / std::cbrt(axes.x * axes.y * axes.z));
  return analytic(AnalyticKind::ellipsoid, a, superellipsoid_inertia(a, 1, 1), superellipsoid_area(a, 1, 1),
                  std::max({a.x, a.y, a.z}));
}

Shape make_superellipsoid(Vec3 axes, double exponent_ns, double exponent_ew) {
  require_axes("superellipsoid", axes);
  for (double e : {exponent_ns, exponent_ew})
    if (!(e >= 0.1 && e <= 1.9)) throw std::invalid_argument("superellipsoid: exponents must be in 0.1..1.9");
  double const volume = superellipsoid_volume(axes, exponent_ns, exponent_ew);
  Vec3 const a = axes * std::cbrt(std::numbers::pi / 6 / volume);
  double const radius = longest(longest(a.x, a.y, 2 / exponent_ew), a.z, 2 / exponent_ns);
  Shape s = analytic(AnalyticKind::superellipsoid, a, superellipsoid_inertia(a, exponent_ns, exponent_ew),
                     superellipsoid_area(a, exponent_ns, exponent_ew), radius);
  s.analytic.exponent_ns = exponent_ns;
  s.analytic.exponent_ew = exponent_ew;
  return s;
}

Shape make_box(Vec3 axes) {
  require_axes("box", axes);
  Vec3 const h = axes * (0.5 * std::cbrt(std::numbers::pi / 6 / (axes.x * axes.y * axes.z)));
  double constexpr volume = std::numbers::pi / 6;
  Vec3 const inertia = Vec3{h.y * h.y + h.z * h.z, h.x * h.x + h.z * h.z, h.x * h.x + h.y * h.y} * (volume / 3);
  return analytic(AnalyticKind::box, h, inertia, 8 * (h.x * h.y + h.y * h.z + h.z * h.x), norm(h));
}

bool is_builtin_shape(std::string const& spec) {
  std::string const kind = spec.substr(0, spec.find(':'));
  return kind == "sphere" || kind == "ellipsoid" || kind == "superellipsoid" || kind == "box";
}

Shape builtin_shape(std::string const& spec) {
  if (!is_builtin_shape(spec)) refuse(spec, "unknown kind");
  AnalyticKind const kind = analytic_kind_from_string(spec.substr(0, spec.find(':')));
  try {
    Shape s = from_numbers(spec, kind, numbers_after_kind(spec));
    s.name = s.certificate.source = spec;
    return s;
  } catch (std::invalid_argument const& e) {
    if (std::string(e.what()).rfind("shape '", 0) == 0) throw;
    refuse(spec, e.what());
  }
}

}  // namespace scree
