// scree_envelopes.cpp: `scree envelopes`: ways of the grains of results as tables and pictures.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "core/case.h"
#include "core/envelopes.h"
#include "tools/plot_script.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

void check_folder(fs::path const& folder, bool force) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw InputError({folder.string() + " is a file; --output names a folder"});
  if (force) return;
  for (fs::path const& file : envelope_files(folder))
    if (fs::exists(file, error)) throw InputError({file.string() + " exists; choose another --output or add --force"});
}

void print(Envelopes const& e) {
  fmt::print("direction [{:.4g}, {:.4g}, {:.4g}], bins {:g} m\n", e.along.x, e.along.y, e.along.z, e.bin);
  fmt::print("{:<20} {:>8} {:>7} {:>7} {:>7} {:>7} {:>24} {:>12}\n", "group", "replicas", "grains", "stopped", "moving",
             "left", "run-out mean, 95 %, max", "sideways");
  for (std::size_t g = 0; g < e.group.size(); ++g) {
    EnvelopeGroup const& group = e.group[g];
    int count[3] = {};
    for (GrainWay const& way : e.grain)
      if (way.group == static_cast<int>(g)) ++count[static_cast<int>(way.fate)];
    fmt::print("{:<20} {:>8} {:>7} {:>7} {:>7} {:>7} {:>8.4g} {:>7.4g} {:>7.4g} {:>10.4g} m\n", group.name,
               group.replicas, group.grains, count[0], count[1], count[2], group.run_out.mean, group.run_out.high,
               group.run_out.largest, group.sideways);
  }
  if (e.waiting > 0) fmt::print("{} grains were not inserted yet and count nowhere\n", e.waiting);
}

}  // namespace

int envelopes_command(EnvelopesArguments const& a) {
  check_folder(a.folder, a.force);
  EnvelopeOptions options;
  if (!a.direction.empty()) options.direction = Vec3{a.direction[0], a.direction[1], a.direction[2]};
  options.bin = a.bin;
  options.recover = a.recover;
  Envelopes const envelopes = measure_envelopes(a.results, options);
  fs::create_directories(a.folder);
  write_envelopes(envelopes, a.folder);
  print(envelopes);
  std::string const trouble = run_plot_script(plot_envelopes_text, {a.folder.string()});
  fmt::print("{}: tables (.csv){}\n", a.folder.string(),
             trouble.empty() ? ", envelopes.png, plan.png" : "; no pictures: " + trouble);
  return exit_ok;
}

}  // namespace scree
