// scree_train.cpp: the training program: networks from meshes and formulas.
// Links LibTorch and CGAL; distributed binaries are under GPL-3 because of CGAL.
// SPDX-License-Identifier: Apache-2.0
#include "tools/guarded.h"
#include "tools/model_export.h"
#include "tools/train_commands.h"

int main(int argc, char** argv) {
  using namespace scree;
  CLI::App app{"Train signed distance networks of grains"};
  app.set_version_flag("--version",
                       "scree-train " SCREE_VERSION
                       "\nScree is Apache-2.0; this program contains CGAL and is distributed under GPL-3.");
  app.require_subcommand(1);
  std::function<int()> chosen;
  add_fit_command(app, chosen);
  add_coded_command(app, chosen);
  add_encode_command(app, chosen);
  add_study_command(app, chosen);
  add_dataset_command(app, chosen);
  add_model_export(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;
  }
  return guarded("scree-train", chosen);
}
