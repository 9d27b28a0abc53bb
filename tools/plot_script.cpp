// plot_script.cpp: runs tools/python/plot_study.py, which is part of the program.
// SPDX-License-Identifier: Apache-2.0
#include "tools/plot_script.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

namespace scree {

extern char const plot_study_text[];  // in a source that CMake makes from the script

namespace {

char constexpr python[] = "/usr/bin/python3";  // the distribution's: another one on the path has other libraries

// As one word of the shell.
std::string quoted(std::string const& text) {
  std::string result = "'";
  for (char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

int exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }

}  // namespace

std::string plot_study(std::string const& study, std::filesystem::path const& folder) {
  std::string const check = std::string(python) + " -c 'import matplotlib' 2>/dev/null";
  if (exit_code(std::system(check.c_str())) != 0)
    return "Matplotlib was not found; install python3-matplotlib, then add --plot-only";
  // The script goes through standard input: there is no file to lose.
  std::fflush(stdout);
  std::string const command = std::string(python) + " - " + quoted(study) + " " + quoted(folder.string());
  FILE* const pipe = ::popen(command.c_str(), "w");
  if (!pipe) return "Python could not be started";
  std::fputs(plot_study_text, pipe);
  int const code = exit_code(::pclose(pipe));
  return code == 0 ? "" : "the plotting script failed with exit code " + std::to_string(code);
}

}  // namespace scree
