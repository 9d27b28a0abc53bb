// run_checkpoints.h: what `scree run` adds to a Simulation's checkpoints: when they are written, and which frames an
// earlier process had written when one was.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/case.h"
#include "core/checkpoint_folder.h"
#include "core/simulation.h"
#include "tools/scree_folder.h"

namespace scree {

// Checkpoints of a run that goes. Without [checkpoint] only stopping writes one.
class RunCheckpoints {
 public:
  RunCheckpoints(std::filesystem::path const& output, Case const& c, Simulation const& simulation);
  // Whether the schedule asks for one at this step.
  bool due(Simulation const& simulation) const;
  std::filesystem::path write(Simulation const& simulation, OutputProgress const& output);
  std::filesystem::path write_stopped(Simulation const& simulation, OutputProgress const& output) const;
  bool scheduled() const { return every_.has_value(); }

 private:
  CheckpointFolder folder_;
  std::optional<double> every_;  // [s]
  int keep_ = CheckpointCase{}.keep;
  double next_ = 0;  // [s]
};

// The checkpoint that `output` can be gone on from; none where no run has been. Throws InputError for a run without a
// usable checkpoint. What was passed by goes to `messages`.
std::optional<Checkpoint> checkpoint_to_resume(std::filesystem::path const& output, std::vector<std::string>& messages);

// The frames and ledger rows up to a checkpoint that an earlier process wrote into `output`: from its journal, or from
// its finished results.h5.
class EarlierFrames {
 public:
  // Throws InputError when they, or what measures.csv and contacts.csv had, are not there.
  EarlierFrames(std::filesystem::path const& output, OutputProgress const& progress);
  void for_each(std::function<void(Frame const&, LedgerRow const&)> const& visit) const;
  // Bytes of the journal that hold them; 0: they come from results.h5 and have to be written into a new journal.
  std::int64_t journal_bytes() const { return journal_bytes_; }

 private:
  std::filesystem::path journal_, results_;
  std::int64_t frames_, journal_bytes_ = 0;
};

}  // namespace scree
