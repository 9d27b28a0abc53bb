// measured_on.cpp: see measured_on.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/measured_on.h"

#include <ctime>
#include <fstream>

namespace scree {

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string utc_date() {
  std::time_t const t = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&t));
  return text;
}

}  // namespace scree
