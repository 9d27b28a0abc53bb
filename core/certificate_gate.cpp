// certificate_gate.cpp: see certificate_gate.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/certificate_gate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

namespace scree {
namespace {

double handles(Certificate const& c) {
  bool const measured = c.components >= 0 && c.euler != 1;
  return measured ? c.components - 0.5 * c.euler : -1;  // each part has Euler characteristic 2 - 2 handles
}

CertificateLimit constexpr limit_table[] = {
    {"components", &LimitsCase::components, [](Certificate const& c) { return double(c.components); }, true,
     "pieces of the surface, voids inside counted"},
    {"handles", &LimitsCase::handles, handles, true, "holes through the body"},
    {"falling", &LimitsCase::falling, [](Certificate const& c) { return c.falling; }, true,
     "share of the interior in which phi falls inwards, so that deep overlaps lose force"},
    {"gap", &LimitsCase::gap, [](Certificate const& c) { return c.gap; }, false,
     "largest blind gap between its surface nodes [d]"},
    {"mae", &LimitsCase::mae, [](Certificate const& c) { return c.mae; }, false, "mean error of phi [d]"},
    {"hausdorff", &LimitsCase::hausdorff, [](Certificate const& c) { return c.hausdorff; }, false,
     "largest distance of its surface from the source's [d]"},
    {"volume", &LimitsCase::volume, [](Certificate const& c) { return c.volume_error; }, false,
     "relative error of its volume"},
    {"inertia", &LimitsCase::inertia, [](Certificate const& c) { return c.inertia_error; }, false,
     "relative error of its inertia"},
};

bool has_gradient(Certificate const& c) { return c.gradient_p1 >= 0 && c.gradient_p99 >= 0; }

}  // namespace

Span<CertificateLimit const> certificate_limits() { return {limit_table, static_cast<int>(std::size(limit_table))}; }

std::vector<std::string> gate_problems(Shape const& shape, std::filesystem::path const& model,
                                       LimitsCase const& limits) {
  std::vector<std::string> found;
  if (!shape.is_net()) return found;
  Certificate const& c = shape.certificate;
  std::vector<std::string> unmeasured;
  if (!has_gradient(c)) unmeasured.push_back("gradient");
  for (CertificateLimit const& l : limit_table)
    if (l.from_phi && l.figure(c) < 0) unmeasured.push_back(l.name);
  if (!unmeasured.empty())
    found.push_back(
        fmt::format("shape '{}' has no certificate for {}: never measured. `scree-shape inspect {} --write` "
                    "measures it and writes it into the file",
                    shape.name, fmt::join(unmeasured, ", "), model.filename().string()));
  if (has_gradient(c) && (c.gradient_p1 < limits.gradient_low || c.gradient_p99 > limits.gradient_high))
    found.push_back(
        fmt::format("shape '{}': |grad phi| of its certificate runs from {:.3g} to {:.3g} (1st and 99th "
                    "percentile), limits.gradient allows [{:.3g}, {:.3g}]. Train it longer or with more "
                    "samples, or set limits.gradient in the case",
                    shape.name, c.gradient_p1, c.gradient_p99, limits.gradient_low, limits.gradient_high));
  for (CertificateLimit const& l : limit_table)
    if (double const value = l.figure(c); value > limits.*l.limit)
      found.push_back(
          fmt::format("shape '{}': {} of its certificate is {:.3g} ({}), limits.{} allows {:.3g}. Train it "
                      "longer or with more samples, or set limits.{} in the case",
                      shape.name, l.name, value, l.meaning, l.name, limits.*l.limit, l.name));
  return found;
}

std::vector<std::string> limits_set(LimitsCase const& limits) {
  LimitsCase const usual;
  std::vector<std::string> lines;
  if (limits.gradient_low != usual.gradient_low || limits.gradient_high != usual.gradient_high)
    lines.push_back(fmt::format("limits.gradient = [{}, {}] set by the case (default [{}, {}])", limits.gradient_low,
                                limits.gradient_high, usual.gradient_low, usual.gradient_high));
  for (CertificateLimit const& l : limit_table)
    if (limits.*l.limit != usual.*l.limit)
      lines.push_back(
          fmt::format("limits.{} = {} set by the case (default {})", l.name, limits.*l.limit, usual.*l.limit));
  return lines;
}

}  // namespace scree
