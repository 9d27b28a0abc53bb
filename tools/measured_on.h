// measured_on.h: what a measurement was made on and when: nobody can use a time without it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace scree {

std::string cpu_name();  // "AMD EPYC 7763 64-Core Processor"; "unknown" where Linux does not say
std::string utc_date();  // "2026-01-31T23:59:59Z"

}  // namespace scree
