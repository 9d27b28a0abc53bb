// build_info.h: what this program was built from: version, commit, compiler, optional parts.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace scree {

struct BuildInfo {
  char const* version;     // "0.1.0"
  char const* commit;      // 12 digits, with "-modified" where the tree differed from it; "unknown" without git
  char const* compiler;    // "GNU 12.2.0"
  char const* build_type;  // "Release"
  char const* features;    // optional parts built: "cuda mesh training benchmarks"
};

BuildInfo const& build_info();

}  // namespace scree
