// google_benchmarks.h: what the programs on Google Benchmark do with the options that are not their own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace scree::bench {

// Hands `flags` to Google Benchmark, which keeps `program`, argv[0]. False: one is unknown, which it has said.
inline bool take_benchmark_flags(char* program, std::vector<std::string> flags) {
  std::vector<char*> pointers{program};
  for (std::string& f : flags) pointers.push_back(f.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  return !benchmark::ReportUnrecognizedArguments(count, pointers.data());
}

}  // namespace scree::bench
