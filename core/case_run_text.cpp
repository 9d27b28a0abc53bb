// case_run_text.cpp: see case_run_text.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_run_text.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/case_range.h"
#include "core/certificate_gate.h"

namespace scree {
namespace {

void read_device(CaseReader r, DeviceCase& out) {
  using P = Precision;
  r.choice<P>("precision", out.precision, {{"fp32", P::fp32}, {"fp16x3", P::fp16x3}, {"fast", P::fast}});
  r.finish();
}

void read_output(CaseReader r, OutputCase& out) {
  r.number("every", out.every);
  r.boolean("paraview", out.paraview);
  r.finish();
}

void read_checkpoint(CaseReader r, CheckpointCase& out) {
  r.number("every", out.every);
  r.integer("keep", out.keep);
  r.finish();
}

void read_relax(CaseReader r, RelaxCase& out) {
  r.number("overlap", out.overlap);
  r.number("travel", out.travel);
  r.integer("passes", out.passes);
  r.finish();
}

void read_limits(CaseReader r, LimitsCase& out) {
  r.number("overlap", out.overlap);
  r.interval("gradient", out.gradient_low, out.gradient_high);
  r.number("ledger", out.ledger);
  for (CertificateLimit const& l : certificate_limits()) r.number(l.name, out.*l.limit);
  r.finish();
}

void read_accuracy(CaseReader r, AccuracyCase& out) {
  r.number("budget", out.budget);
  using P = AccuracyPreset;
  r.choice<P>("preset", out.preset, {{"fast", P::fast}, {"balanced", P::balanced}, {"reference", P::reference}});
  r.number("overlap", out.overlap);
  r.finish();
}

char const* to_string(AccuracyPreset preset) {
  switch (preset) {
    case AccuracyPreset::fast:
      return "fast";
    case AccuracyPreset::balanced:
      return "balanced";
    case AccuracyPreset::reference:
      return "reference";
    case AccuracyPreset::none:
      break;
  }
  throw std::invalid_argument("this AccuracyPreset has no name");
}

}  // namespace

double budget_of(AccuracyPreset preset) {
  switch (preset) {
    case AccuracyPreset::fast:
      return 0.15;
    case AccuracyPreset::balanced:
      return 0.03;
    case AccuracyPreset::reference:
      return 0.003;
    case AccuracyPreset::none:
      break;
  }
  throw std::invalid_argument("this AccuracyPreset has no budget");
}

void read_run(CaseReader& root, Case& out) {
  if (auto accuracy = root.table("accuracy")) read_accuracy(*accuracy, out.accuracy.emplace());
  if (auto device = root.table("device")) read_device(*device, out.device.emplace());
  if (auto output = root.table("output")) read_output(*output, out.output);
  if (auto checkpoint = root.table("checkpoint")) read_checkpoint(*checkpoint, out.checkpoint.emplace());
  if (auto limits = root.table("limits")) read_limits(*limits, out.limits);
  if (auto relax = root.table("relax")) read_relax(*relax, out.relax.emplace());
}

void check_run(Case const& c, std::vector<CaseProblem>& found) {
  auto const fail = [&](std::string const& key, std::string const& text) { found.push_back({key, text}); };
  auto const range = [&](std::string const& key, double value, double low, bool low_allowed, double high,
                         char const* reason) {
    if (std::string const wrong = out_of_range(value, low, low_allowed, high, reason); !wrong.empty()) fail(key, wrong);
  };
  auto const positive = [&](std::string const& key, double value, char const* reason) {
    range(key, value, 0, false, std::numeric_limits<double>::infinity(), reason);
  };
  if (c.accuracy) {
    AccuracyCase const& a = *c.accuracy;
    if (a.budget.has_value() == (a.preset != AccuracyPreset::none))
      fail("accuracy.budget", "give exactly one of budget and preset; leave [accuracy] out for neither");
    if (a.budget) range("accuracy.budget", *a.budget, 1e-3, true, 0.5, "the relative error of a contact's force");
    if (a.overlap) range("accuracy.overlap", *a.overlap, 0, false, 0.1, "d; the contacts that the budget is for");
    for (std::size_t i = 0; i < c.grains.size(); ++i)
      if (c.grains[i].storage == NodeStorage::compact && !c.grains[i].nodes_given)
        fail(fmt::format("grains.{}.storage", i),
             "[accuracy] counts nodes that are kept as arrays: give `nodes` beside \"compact\", or use \"explicit\"");
  }
  positive("output.every", c.output.every, "seconds between frames");
  if (c.checkpoint) {
    positive("checkpoint.every", c.checkpoint->every, "seconds between checkpoints");
    range("checkpoint.keep", c.checkpoint->keep, 1, true, 1000, "checkpoints kept");
  }
  if (c.relax) {
    range("relax.overlap", c.relax->overlap, 0, false, 0.5, "d; relaxing ends when no contact is deeper");
    range("relax.travel", c.relax->travel, 0, false, 0.1, "d that a point may move in one pass");
    range("relax.passes", c.relax->passes, 1, true, 1e6, "passes");
  }
  LimitsCase const& l = c.limits;
  range("limits.overlap", l.overlap, 0, false, 0.5, "d; the watch stops the run above it");
  bool const ordered =
      l.gradient_low > 0 && l.gradient_low < 1 && l.gradient_high > 1 && std::isfinite(l.gradient_high);
  if (!ordered)
    fail("limits.gradient", fmt::format("[{}, {}] must enclose 1 and be > 0: |grad phi| of a true distance is 1",
                                        l.gradient_low, l.gradient_high));
  positive("limits.ledger", l.ledger, "a share of the energy moved");
  for (CertificateLimit const& limit : certificate_limits())
    if (double const value = l.*limit.limit; !(std::isfinite(value) && value >= 0))
      fail(std::string("limits.") + limit.name, fmt::format("{} must be >= 0: {}", value, limit.meaning));
}

std::string run_to_toml(Case const& c) {
  std::string out;
  if (c.accuracy) {
    out += c.accuracy->budget ? fmt::format("\n[accuracy]\nbudget = {}\n", *c.accuracy->budget)
                              : fmt::format("\n[accuracy]\npreset = \"{}\"\n", to_string(c.accuracy->preset));
    if (c.accuracy->overlap) out += fmt::format("overlap = {}  # [d]\n", *c.accuracy->overlap);
  }
  if (c.device) out += fmt::format("\n[device]\nprecision = \"{}\"\n", to_string(c.device->precision));
  out += fmt::format("\n[output]\nevery = {}  # [s]\nparaview = {}\n", c.output.every, c.output.paraview);
  if (c.checkpoint)
    out += fmt::format("\n[checkpoint]\nevery = {}  # [s]\nkeep = {}\n", c.checkpoint->every, c.checkpoint->keep);
  if (c.relax)
    out += fmt::format("\n[relax]\noverlap = {}  # [d]\ntravel = {}  # [d]\npasses = {}\n", c.relax->overlap,
                       c.relax->travel, c.relax->passes);
  out += fmt::format("\n[limits]\noverlap = {}  # [d]\ngradient = [{}, {}]\nledger = {}\n", c.limits.overlap,
                     c.limits.gradient_low, c.limits.gradient_high, c.limits.ledger);
  for (CertificateLimit const& l : certificate_limits())
    out += fmt::format("{} = {}  # {}\n", l.name, c.limits.*l.limit, l.meaning);
  return out;
}

}  // namespace scree
