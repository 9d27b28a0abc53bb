// model_export.h: the command `export` of scree-train and scree-shape.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace scree {

// Adds the subcommand, which sets `chosen` when it is called.
void add_model_export(CLI::App& app, std::function<int()>& chosen);

}  // namespace scree
