// scree_report.h: what a run tells while it goes and when it ends: progress, log, time per stage, energy ledger.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/appended_file.h"
#include "core/simulation.h"

namespace scree {

// Messages go to the terminal and, with a time stamp, into run.log.
class RunLog {
 public:
  RunLog(std::filesystem::path const& file, bool append);  // throws std::system_error
  void write(std::string const& line);                     // file only
  void say(std::string const& line);                       // both; a run does not end because nobody hears it

 private:
  AppendedFile file_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A bar on a terminal, plain lines when piped: at 1, 5 and 15 s, then every 30 s.
class Progress {
 public:
  Progress(double start, double end, bool quiet);  // of the simulated time [s]
  void show(Simulation const& simulation);
  void clear();  // before other output

 private:
  double elapsed() const;
  std::string line(Simulation const& simulation) const;

  double begin_, end_;
  bool quiet_, terminal_, drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  double next_ = 0;  // [s] of wall time
  int shown_ = 0;
};

std::string duration(double seconds);     // "3:07", "1:02:03", "12.3 s"
std::string grouped(std::int64_t count);  // "12 345 678"
std::vector<StageRow> stage_rows(Profile const& profile);
std::string stage_table(std::vector<StageRow> const& rows, double wall);
std::string ledger_table(LedgerRow const& row);

// What the networks' arithmetic took, beside what the machine's units could do in that time.
struct NetworkRate {
  double flop = 0;     // useful ones
  double seconds = 0;  // of the stages that make them
  int threads = 1;
  double peak = 0;  // of all threads [FLOP/s]; 0: not known

  double per_second() const { return seconds > 0 ? flop / seconds : 0; }
};
// `peak` is measured here, where the run made any.
NetworkRate network_rate(QueryCounts const& counts, std::vector<StageRow> const& rows, int threads);
// Two lines: queries made, and those left out and why; the networks' share of the peak. Empty without surface nodes.
std::string query_table(QueryCounts const& counts, NetworkRate const& rate);

std::string stages_json(std::vector<StageRow> const& rows, NetworkRate const& rate, Simulation const& simulation,
                        double wall);

}  // namespace scree
