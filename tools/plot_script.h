// plot_script.h: runs a script of tools/python, which is part of the program.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace scree {

// The scripts' texts, each in a source that CMake makes from tools/python/<name>.py for the programs that use it.
extern char const plot_book_text[];
extern char const plot_certificate_text[];
extern char const plot_cost_text[];
extern char const plot_energy_text[];
extern char const plot_envelopes_text[];
extern char const plot_study_text[];

// Runs the text with Debian's Python and its Matplotlib; `arguments` as the script's head says. Returns "" or what
// prevented it, in one line.
std::string run_plot_script(char const* text, std::vector<std::string> const& arguments);

}  // namespace scree
