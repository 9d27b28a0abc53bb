// guarded.h: what goes wrong in scree-shape, scree-train and the benchmarks: one message, an exit code.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <stdexcept>

namespace scree {

// As in tools/README.md.
enum ExitCode : int { exit_ok = 0, exit_bad_input = 2, exit_file = 4 };

// Runs `work` and returns its exit code. std::invalid_argument is bad input; everything else thrown is a file or the
// machine. The message goes to stderr, after what `work` had printed.
inline int guarded(char const* program, std::function<int()> const& work) {
  auto const complain = [&](ExitCode code, char const* what) {
    std::fflush(stdout);
    fmt::print(stderr, "{}: error: {}\n", program, what);
    return code;
  };
  try {
    int const code = work();
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
    return code != exit_ok ? code : complain(exit_file, "standard output: cannot be written; is the disk full?");
  } catch (std::invalid_argument const& error) {
    return complain(exit_bad_input, error.what());
  } catch (std::exception const& error) {
    return complain(exit_file, error.what());
  }
}

}  // namespace scree
