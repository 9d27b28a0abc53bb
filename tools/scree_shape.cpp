// scree_shape.cpp: the shape program: check and repair meshes, inspect model files, make new shapes.
// Links CGAL; distributed binaries are under GPL-3 because of it. Commands: shape_commands.h.
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <functional>

#include "tools/guarded.h"
#include "tools/model_export.h"
#include "tools/shape_commands.h"

int main(int argc, char** argv) {
  using namespace scree;
  CLI::App app{"Check and repair meshes, inspect model files, make new shapes"};
  app.set_version_flag("--version",
                       "scree-shape " SCREE_VERSION
                       "\nScree is Apache-2.0; this program contains CGAL and is distributed under GPL-3.");
  app.require_subcommand(1);
  std::function<int()> chosen;
  add_import(app, chosen);
  add_inspect(app, chosen);
  add_points(app, chosen);
  add_reconstruct(app, chosen);
  add_interpolate(app, chosen);
  add_sample(app, chosen);
  add_model_export(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;
  }
  return guarded("scree-shape", chosen);
}
