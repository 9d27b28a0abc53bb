// certificate_gate.h: which networks may run: the figures of their certificates against the limits of the case.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/case.h"
#include "kernels/base/span.h"
#include "shapes/shape.h"

namespace scree {

// One limit a case can set, `limits.<name>`: the largest value allowed of one figure.
struct CertificateLimit {
  char const* name;
  double LimitsCase::*limit;
  double (*figure)(Certificate const&);  // negative: not measured
  bool from_phi;                         // phi alone tells it, so that a network without it is refused
  char const* meaning;
};
Span<CertificateLimit const> certificate_limits();

// Why a network may not run, a line a reason that names shape, limit, value and the way out; empty for shapes that are
// no networks and for good ones. What only a truth could tell is not asked of shapes that have none, nor the gap of
// shapes made by the hundred: nodes are made anew for the case's own number.
std::vector<std::string> gate_problems(Shape const& shape, std::filesystem::path const& model,
                                       LimitsCase const& limits);

// "limits.mae = 0.02 set by the case (default 0.01)" for each limit of a certificate that is not the default.
std::vector<std::string> limits_set(LimitsCase const& limits);

}  // namespace scree
