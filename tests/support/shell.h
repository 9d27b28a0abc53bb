// shell.h: what a command says and how it ends, for tests of programs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace scree::testing {

struct Outcome {
  int code = -1;     // exit code; 1000 + signal
  std::string text;  // stdout and stderr
};

// A shell command in a folder.
inline Outcome shell(std::filesystem::path const& folder, std::string const& command) {
  Outcome outcome;
  std::string const whole = "cd '" + folder.string() + "' && { " + command + "; } 2>&1";
  std::FILE* const pipe = ::popen(whole.c_str(), "r");
  std::array<char, 4096> buffer;
  while (std::size_t const n = std::fread(buffer.data(), 1, buffer.size(), pipe)) outcome.text.append(buffer.data(), n);
  int const status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  return outcome;
}

}  // namespace scree::testing
