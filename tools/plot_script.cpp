// plot_script.cpp: see plot_script.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/plot_script.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

namespace scree {

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

std::string run_plot_script(char const* text, std::vector<std::string> const& arguments) {
  std::string const check = std::string(python) + " -c 'import matplotlib' 2>/dev/null";
  if (exit_code(std::system(check.c_str())) != 0) return "Matplotlib was not found; install python3-matplotlib";
  // The script goes through standard input: there is no file to lose.
  std::fflush(stdout);
  std::string command = std::string(python) + " -";
  for (std::string const& argument : arguments) command += " " + quoted(argument);
  FILE* const pipe = ::popen(command.c_str(), "w");
  if (!pipe) return "Python could not be started";
  std::fputs(text, pipe);
  int const code = exit_code(::pclose(pipe));
  return code == 0 ? "" : "the plotting script failed with exit code " + std::to_string(code);
}

}  // namespace scree
