// scree_report.cpp: see scree_report.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/scree_report.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/build_info.h"
#include "kernels/sdf/sdf_batch.h"
#include "tools/bench/peak_meter.h"

namespace scree {

RunLog::RunLog(std::filesystem::path const& file, bool append) : file_(file, append ? AppendedFile::all : 0) {}

void RunLog::write(std::string const& line) {
  double const t = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  file_.append(fmt::format("{:10.3f}  {}\n", t, line));
}

void RunLog::say(std::string const& line) {
  std::fputs((line + "\n").c_str(), stdout);  // what fails here is told at the end of the program
  std::fflush(stdout);
  write(line);
}

Progress::Progress(double start, double end, bool quiet)
    : begin_(start),
      end_(end),
      quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  next_ = terminal_ ? 0.1 : 1;
}

double Progress::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

// The remaining time counts to time.end; a settle stage may stop earlier, hence "at most".
std::string Progress::line(Simulation const& s) const {
  double const wall = elapsed(), share = std::clamp((s.time() - begin_) / std::max(end_ - begin_, 1e-300), 0.0, 1.0);
  std::string const left = share > 1e-6 ? duration(wall * (1 - share) / share) : "?";
  return fmt::format(
      "t {:.4f} of {:g} s, {}, step {}, dt {:.2e} s, {:.0f} steps/s, overlap {:.2f} % d, kinetic {:.1e} m g d, at most "
      "{} left",
      s.time(), end_, s.phase(), grouped(s.steps()), s.time_step(),
      static_cast<double>(s.own_steps()) / std::max(wall, 1e-9), 100 * s.largest_overlap(),
      s.largest_kinetic_per_grain(), left);
}

void Progress::show(Simulation const& s) {
  double const wall = elapsed();
  if (quiet_ || wall < next_) return;
  ++shown_;
  if (!terminal_) {
    next_ = shown_ == 1 ? 5 : shown_ == 2 ? 15 : wall + 30;
    fmt::print(stderr, "{:3.0f} %  {}\n", 100 * s.time() / end_, line(s));
    return;
  }
  next_ = wall + 0.2;
  int constexpr width = 24;
  int const full = static_cast<int>(width * std::clamp(s.time() / end_, 0.0, 1.0));
  fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {:3.0f} %  {}\x1b[K", "", full, "", width - full, 100 * s.time() / end_,
             line(s));
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  auto const whole = static_cast<std::int64_t>(std::lround(seconds));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string grouped(std::int64_t count) {
  std::string digits = std::to_string(std::abs(count));
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3) digits.insert(static_cast<std::size_t>(at), " ");
  return (count < 0 ? "-" : "") + digits;
}

std::vector<StageRow> stage_rows(Profile const& profile) {
  std::vector<StageRow> rows;
  for (Profile::Entry const& e : profile.entries()) rows.push_back({e.name, e.seconds, e.calls, e.items});
  return rows;
}

std::string stage_table(std::vector<StageRow> const& rows, double wall) {
  std::string out = fmt::format("{:<28} {:>10} {:>7} {:>11} {:>11} {:>12}\n", "stage", "seconds", "share", "calls",
                                "us/call", "M items/s");
  std::vector<StageRow> sorted = rows;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](StageRow const& a, StageRow const& b) { return a.seconds > b.seconds; });
  double sum = 0;
  for (StageRow const& r : sorted) {
    sum += r.seconds;
    double const calls = static_cast<double>(std::max<std::int64_t>(r.calls, 1));
    out += fmt::format("{:<28} {:>10.3f} {:>6.1f}% {:>11} {:>11.2f} {:>12.3f}\n", r.name, r.seconds,
                       100 * r.seconds / wall, grouped(r.calls), 1e6 * r.seconds / calls,
                       1e-6 * static_cast<double>(r.items) / std::max(r.seconds, 1e-12));
  }
  return out + fmt::format("{:<28} {:>10.3f} {:>6.1f}%\n", "outside stages", wall - sum, 100 * (wall - sum) / wall);
}

std::string ledger_table(LedgerRow const& r) {
  std::string out = "energy ledger [J]\n";
  auto const row = [&](char const* name, double value) { out += fmt::format("  {:<44} {:>14.6e}\n", name, value); };
  row("kinetic", r.kinetic);
  row("potential", r.potential);
  row("elastic, normal", r.elastic_normal);
  row("elastic, tangential", r.elastic_tangential);
  if (r.inserted != 0) row("brought in by insertion", r.inserted);
  row("work of walls", r.wall_work);
  if (r.applied != 0) row("work of applied forces", r.applied);
  row("lost to contact damping", r.damping);
  row("lost to friction", r.friction);
  if (r.global_damping != 0) row("lost to global damping", r.global_damping);
  if (r.elastic_rolling != 0) row("elastic, rolling", r.elastic_rolling);
  if (r.rolling != 0) row("lost to rolling resistance", r.rolling);
  if (r.drag != 0) row("lost to drag", r.drag);
  if (r.deleted != 0) row("of deleted bodies", r.deleted);
  row("removed by the program", r.removed);
  row("not accounted for", r.residual);
  return out + fmt::format("  {:<44} {:>14.2e}\n", "not accounted for / energy moved",
                           r.moved > 0 ? std::abs(r.residual) / r.moved : 0.0);
}

NetworkRate network_rate(QueryCounts const& counts, std::vector<StageRow> const& rows, int threads) {
  NetworkRate out;
  out.threads = threads;
  if (!(counts.flop > 0)) return out;
  out.flop = counts.flop;
  for (StageRow const& r : rows)
    if (r.name == "sdf_net/forward" || r.name == "sdf_net/gradient") out.seconds += r.seconds;
  out.peak = bench::measure_peak(threads);
  return out;
}

std::string query_table(QueryCounts const& c, NetworkRate const& rate) {
  if (c.nodes == 0) return {};
  auto const percent = [&](std::int64_t part) {
    return 100 * static_cast<double>(part) / static_cast<double>(c.nodes);
  };
  std::string out = fmt::format(
      "queries   {} for {} nodes of near pairs, {:.3g} %: {} of nodes, {} again for a gradient, {} of blocks\n"
      "left out  {:.4g} % of the nodes were in no list, too far away when it was made; {:.4g} % could not have come "
      "inside since their last query",
      grouped(c.made()), grouped(c.nodes), percent(c.made()), grouped(c.due), grouped(c.again), grouped(c.blocks),
      percent(c.nodes - c.listed), percent(c.listed - c.due));
  if (rate.flop > 0) out += fmt::format("\nnetworks  {:.3g} GFLOP/s", 1e-9 * rate.per_second());
  if (rate.flop > 0 && rate.peak > 0)
    out +=
        fmt::format(", {:.3g} % of the {:.3g} that {} thread{} can do, measured now",
                    100 * rate.per_second() / rate.peak, 1e-9 * rate.peak, rate.threads, rate.threads == 1 ? "" : "s");
  return out;
}

std::string stages_json(std::vector<StageRow> const& rows, NetworkRate const& rate, Simulation const& s, double wall) {
  std::string out = fmt::format(
      "{{\n  \"version\": \"{}\",\n  \"commit\": \"{}\",\n  \"sdf_isa\": \"{}\",\n  \"threads\": {},\n  \"bodies\": "
      "{},\n  \"steps\": {},\n"
      "  \"simulated_seconds\": {},\n  \"wall_seconds\": {},\n  \"particle_steps_per_second\": {},\n",
      build_info().version, build_info().commit, sdf_isa(), rate.threads, s.bodies(), s.steps(), s.time(), wall,
      static_cast<double>(s.bodies()) * static_cast<double>(s.own_steps()) / std::max(wall, 1e-9));
  QueryCounts const c = s.query_counts();
  out += fmt::format(
      "  \"queries\": {{\"nodes\": {}, \"listed\": {}, \"due\": {}, \"again\": {}, \"blocks\": {}}},\n"
      "  \"networks\": {{\"flop\": {}, \"seconds\": {}, \"peak_flop_per_second\": {}}},\n  \"stages\": [",
      c.nodes, c.listed, c.due, c.again, c.blocks, rate.flop, rate.seconds, rate.peak);
  for (std::size_t i = 0; i < rows.size(); ++i)
    out += fmt::format("{}\n    {{\"name\": \"{}\", \"seconds\": {}, \"calls\": {}, \"items\": {}}}", i ? "," : "",
                       rows[i].name, rows[i].seconds, rows[i].calls, rows[i].items);
  return out + "\n  ]\n}\n";
}

}  // namespace scree
