// run_checkpoints.cpp: see run_checkpoints.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/run_checkpoints.h"

#include <fmt/format.h>

#include <cmath>

#include "core/frame_journal.h"

namespace scree {

namespace fs = std::filesystem;

namespace {

void require_size(fs::path const& file, std::int64_t bytes) {
  std::error_code error;
  std::uintmax_t const size = fs::file_size(file, error);
  if (bytes > 0 && (error || size < static_cast<std::uintmax_t>(bytes)))
    throw InputError(
        {fmt::format("{}: is missing or shorter than when the checkpoint was written ({} bytes); --force "
                     "starts anew",
                     file.string(), bytes)});
}

}  // namespace

RunCheckpoints::RunCheckpoints(fs::path const& output, Case const& c, Simulation const& simulation)
    : folder_(OutputFolder::checkpoints(output)) {
  if (!c.checkpoint) return;
  every_ = c.checkpoint->every;
  keep_ = c.checkpoint->keep;
  next_ = (std::floor((simulation.time() + simulation.time_step() / 2) / *every_) + 1) * *every_;
}

bool RunCheckpoints::due(Simulation const& s) const { return every_ && s.time() + s.time_step() / 2 >= next_; }

fs::path RunCheckpoints::write(Simulation const& s, OutputProgress const& output) {
  Checkpoint checkpoint = s.checkpoint();
  checkpoint.output = output;
  fs::path const file = folder_.write(checkpoint, keep_);
  if (every_) next_ = (std::floor((s.time() + s.time_step() / 2) / *every_) + 1) * *every_;
  return file;
}

fs::path RunCheckpoints::write_stopped(Simulation const& s, OutputProgress const& output) const {
  Checkpoint checkpoint = s.checkpoint();
  checkpoint.output = output;
  return folder_.write_stopped(checkpoint);
}

std::optional<Checkpoint> checkpoint_to_resume(fs::path const& output, std::vector<std::string>& messages) {
  CheckpointFolder const folder(OutputFolder::checkpoints(output));
  std::optional<Checkpoint> found = folder.newest(messages);
  if (!found && OutputFolder::has_results(output))
    throw InputError(
        {fmt::format("{}: a run wrote here, but no checkpoint to go on from; --force starts anew, and a "
                     "[checkpoint] table in the case makes the next run leave some",
                     output.string())});
  return found;
}

EarlierFrames::EarlierFrames(fs::path const& output, OutputProgress const& progress)
    : journal_(CheckpointFolder(OutputFolder::checkpoints(output)).journal()),
      results_(output / "results.h5"),
      frames_(progress.frames) {
  require_size(output / "measures.csv", progress.measures_bytes);
  require_size(output / "contacts.csv", progress.contacts_bytes);
  Frame frame;
  LedgerRow row;
  std::int64_t journaled = 0;
  {
    JournalReader reader(journal_);
    while (journaled < frames_ && reader.next(frame, row)) ++journaled;
    if (journaled == frames_) journal_bytes_ = reader.offset();
  }
  if (journal_bytes_ > 0 || frames_ == 0) return;
  std::string in_results = "it is missing";
  try {
    ResultsReader const reader(results_);
    if (reader.frames() >= frames_ && static_cast<std::int64_t>(reader.ledger().size()) >= frames_) return;
    in_results = fmt::format("it has {}", reader.frames());
  } catch (InputError const& e) {
    in_results = e.what();
  }
  throw InputError(
      {fmt::format("{}: the checkpoint comes after {} frames, of which {} are in {}, and they are not all "
                   "in results.h5 ({}); --force starts anew",
                   output.string(), frames_, journaled, journal_.string(), in_results)});
}

void EarlierFrames::for_each(std::function<void(Frame const&, LedgerRow const&)> const& visit) const {
  if (frames_ == 0) return;
  if (journal_bytes_ > 0) {
    JournalReader reader(journal_);
    Frame frame;
    LedgerRow row;
    for (std::int64_t i = 0; i < frames_ && reader.next(frame, row); ++i) visit(frame, row);
    return;
  }
  ResultsReader const reader(results_);
  std::vector<LedgerRow> const rows = reader.ledger();
  for (std::int64_t i = 0; i < frames_; ++i) visit(reader.frame(static_cast<int>(i)), rows[i]);
}

}  // namespace scree
