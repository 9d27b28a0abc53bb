// shape_commands.h: the commands of `scree-shape`. Each lives in shape_<command>.cpp with its arguments, its options
// and the function that adds them to the command line.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace scree {

// Each adds one subcommand to `app`. When the user names it, `chosen` becomes the work to do, which returns the exit
// code; its arguments live as long as `chosen`.
void add_import(CLI::App& app, std::function<int()>& chosen);
void add_inspect(CLI::App& app, std::function<int()>& chosen);
void add_points(CLI::App& app, std::function<int()>& chosen);
void add_reconstruct(CLI::App& app, std::function<int()>& chosen);
void add_interpolate(CLI::App& app, std::function<int()>& chosen);
void add_sample(CLI::App& app, std::function<int()>& chosen);

}  // namespace scree
