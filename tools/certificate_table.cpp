// certificate_table.cpp: the figures of certificates as scree-shape and scree-train print them.
// SPDX-License-Identifier: Apache-2.0
#include "tools/certificate_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {
namespace {

std::string figure(double value, char const* format = "{:.2e}") {
  return value < 0 ? std::string("-") : fmt::format(fmt::runtime(format), value);
}
std::string angle(double value) { return figure(value, "{:.2f}"); }
std::string slope(double value) { return figure(value, "{:.3f}"); }
std::string whole(std::int64_t value) { return value < 0 ? "-" : std::to_string(value); }

std::size_t name_width(std::vector<Shape> const& shapes) {
  std::size_t width = 6;  // "errors"
  for (Shape const& s : shapes) width = std::max(width, s.name.size());
  return width;
}

}  // namespace

std::string error_table(std::vector<Shape> const& shapes) {
  std::size_t const name = name_width(shapes);
  std::string out = fmt::format(
      "{:{}}{:>10}{:>9}{:>9}{:>10}{:>9}{:>9}{:>8}{:>7}{:>9}{:>7}{:>10}{:>9}{:>9}\n"
      "{:{}}{:>10}{:>9}{:>9}{:>10}{:>9}{:>9}{:>8}{:>7}{:>9}{:>7}{:>10}{:>9}{:>9}\n",
      "errors", name, "shell", "", "", "band", "", "", "normals", "", "flat", "of it", "Haus-", "volume", "inertia",
      "[d]", name, "MAE", "p99", "max", "MAE", "p99", "max", "p50", "p95", "p95", "[%]", "dorff", "", "");
  for (Shape const& s : shapes) {
    Certificate const& c = s.certificate;
    out += fmt::format("{:{}}{:>10}{:>9}{:>9}{:>10}{:>9}{:>9}{:>8}{:>7}{:>9}{:>7}{:>10}{:>9}{:>9}\n", s.name, name,
                       figure(c.mae), figure(c.p99), figure(c.max), figure(c.band_mae), figure(c.band_p99),
                       figure(c.band_max), angle(c.normal_p50), angle(c.normal_p95), angle(c.flat_normal_p95),
                       figure(100 * c.flat_share, "{:.0f}"), figure(c.hausdorff), figure(c.volume_error, "{:.1e}"),
                       figure(c.inertia_error, "{:.1e}"));
  }
  return out;
}

std::string phi_table(std::vector<Shape> const& shapes) {
  std::size_t const name = name_width(shapes);
  std::string out =
      fmt::format("{:{}}{:>9}{:>8}{:>8}{:>8}{:>8}{:>10}{:>7}{:>7}{:>10}{:>7}{:>6}  {}\n", "phi", name, "|g| p1", "p5",
                  "p95", "p99", "bound", "falling", "parts", "Euler", "gap", "nodes", "seed", "source");
  for (Shape const& s : shapes) {
    Certificate const& c = s.certificate;
    out += fmt::format("{:{}}{:>9}{:>8}{:>8}{:>8}{:>8.3f}{:>10}{:>7}{:>7}{:>10}{:>7}{:>6}  {}\n", s.name, name,
                       slope(c.gradient_p1), slope(c.gradient_p5), slope(c.gradient_p95), slope(c.gradient_p99),
                       s.lipschitz, figure(c.falling), whole(c.components),
                       c.euler == 1 ? "-" : std::to_string(c.euler), figure(c.gap), whole(c.gap_nodes), whole(c.seed),
                       c.source + (c.source_hash.empty() ? "" : " " + c.source_hash));
  }
  return out;
}

}  // namespace scree
