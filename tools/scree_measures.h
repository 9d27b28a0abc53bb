// scree_measures.h: what a run measured: measures.csv while it goes, a table at its end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/appended_file.h"
#include "core/checkpoint.h"
#include "core/expected_figures.h"
#include "core/simulation.h"
#include "tools/scree_folder.h"

namespace scree {

// measures.csv: time, name, quantity, value, a line for every value of every sample. No file without [[measure]].
// contacts.csv: where a measurement has the key `contacts`, the contacts of each sample; b: grain, or -1 - wall.
class MeasureLog {
 public:
  // `earlier`: go on behind what a checkpoint has noted; null: new files. Throws std::system_error.
  MeasureLog(OutputFolder const& folder, Case const& c, Simulation const& simulation, OutputProgress const* earlier);
  void write(Simulation& simulation);          // the samples taken since the last call
  void note_sizes(OutputProgress& out) const;  // of the files, without samples that were taken because the run ends

 private:
  std::vector<std::string> prefix_;                // ",name," of each measure
  std::vector<std::vector<Quantity>> quantities_;  // ... and what it gives
  AppendedFile file_, contacts_;
  std::optional<OutputProgress> on_schedule_;
};

// name,unit,of,value,samples,mean,spread,last: a line a quantity; value is the mean where the case gives a window.
std::string figures_csv(std::vector<MeasureSummary> const& measures);

// Expected, measured, allowed, and whether it is within; `all_ok` says whether every figure is.
std::string check_table(std::vector<FigureCheck> const& checks, bool& all_ok);

std::string measure_table(std::vector<MeasureSummary> const& measures);

}  // namespace scree
