// envelopes.cpp: see envelopes.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/envelopes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "core/case.h"
#include "core/envelope_legs.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

double constexpr nothing = std::numeric_limits<double>::quiet_NaN();
double constexpr rest_speed = 0.05;  // a grain that is slower has stopped [sqrt(g d)]
double constexpr bins_on_the_way = 30;

struct Input {
  std::unique_ptr<ResultsReader> reader;
  EnvelopeCase scene;
  std::vector<int> group;  // of the file's groups, in Envelopes::group
  std::vector<int> grain;  // of the file's bodies, in Envelopes::grain; -1: waiting
};

std::vector<Input> open_all(std::vector<fs::path> const& results, bool recover) {
  std::vector<std::string> problems;
  std::vector<Input> inputs;
  std::set<fs::path> seen;
  if (results.empty()) problems.push_back("no results file is named");
  for (fs::path const& file : results) {
    std::error_code error;
    if (!seen.insert(fs::weakly_canonical(file, error)).second) {
      problems.push_back(file.string() + ": is named twice; its grains would count twice");
      continue;
    }
    try {
      Input input{std::make_unique<ResultsReader>(file, recover), {}, {}, {}};
      input.scene = envelope_case(input.reader->header(), file.string());
      if (input.reader->frames() < 2)
        problems.push_back(
            fmt::format("{}: has {} frames; a way needs at least 2", file.string(), input.reader->frames()));
      inputs.push_back(std::move(input));
    } catch (InputError const& e) {
      problems.insert(problems.end(), e.problems.begin(), e.problems.end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return inputs;
}

void set_directions(EnvelopeOptions const& options, EnvelopeCase const& scene, Envelopes& out) {
  std::optional<Vec3> const direction = options.direction ? options.direction : scene.direction;
  if (!direction)
    throw InputError({"no direction: the case has no run_out measurement; name it with --direction x,y,z"});
  Vec3 const up = norm(scene.gravity) > 0 ? -normalized(scene.gravity) : Vec3{0, 0, 1};
  Vec3 const level = *direction - up * dot(*direction, up);
  if (!is_finite(level) || norm(level) <= 1e-6 * norm(*direction))
    throw InputError(
        {fmt::format("direction [{}, {}, {}]: has no horizontal part", direction->x, direction->y, direction->z)});
  out.along = normalized(level);
  out.across = cross(up, out.along);
}

// 1, 2 or 5 times a power of ten, at least `least`.
double round_number(double least) {
  double const power = std::pow(10, std::floor(std::log10(least)));
  for (double const factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

void name_groups(std::vector<Input>& inputs, Envelopes& out) {
  std::map<std::string, int> index;
  for (Input& input : inputs)
    for (std::string const& name : input.scene.group) {
      auto const [at, fresh] = index.try_emplace(name, static_cast<int>(out.group.size()));
      if (fresh) out.group.emplace_back().name = name;
      input.group.push_back(at->second);
    }
}

// First reading: where each grain started and ended.
void read_ways(int file, Input& input, Envelopes& out) {
  ResultsHeader const& header = input.reader->header();
  input.grain.assign(header.shape.size(), -1);
  std::vector<double> speed(header.shape.size());
  auto const arrive = [&](int body, GrainMoment const& m) {
    GrainWay& way = out.grain[input.grain[body]];
    way.end = m.position;
    speed[body] = norm(m.velocity);
    way.largest_speed = std::max(way.largest_speed, speed[body]);
  };
  walk_legs(
      *input.reader, input.scene.gravity,
      [&](int body, GrainMoment const& m) {
        input.grain[body] = static_cast<int>(out.grain.size());
        GrainWay way{file, header.replica[body], body, input.group.at(header.group[body])};
        way.release = m.position;
        out.grain.push_back(way);
        arrive(body, m);
      },
      [&](GrainLeg const& leg) {
        arrive(leg.body, leg.to);
        if (leg.leaves) out.grain[input.grain[leg.body]].fate = Fate::left;
      });
  for (std::size_t body = 0; body < speed.size(); ++body) {
    if (input.grain[body] < 0) {
      ++out.waiting;
      continue;
    }
    GrainWay& way = out.grain[input.grain[body]];
    Vec3 const way_taken = way.end - way.release;
    way.run_out = dot(way_taken, out.along);
    way.sideways = dot(way_taken, out.across);
    bool const moves = speed[body] > rest_speed * std::sqrt(norm(input.scene.gravity) * header.diameter[body]);
    if (way.fate != Fate::left && moves) way.fate = Fate::moving;
  }
}

using CellPlace = std::pair<int, int>;  // along, across

// What a group collects on the second reading.
struct Collected {
  std::map<CellPlace, EnvelopeGroup::Cell> cell;
  std::map<int, std::vector<double>> energy, rotation;  // of each screen
  std::vector<std::vector<double>> speed;               // of each moment
};

int floor_of(double value) { return static_cast<int>(std::floor(value)); }

// Second reading: passages, screens and speeds of the grains of one file.
class LegCounter {
 public:
  LegCounter(Input const& input, Envelopes const& envelopes, std::vector<Collected>& collected)
      : input_(input), e_(envelopes), collected_(collected), state_(input.grain.size()) {}

  void release(int body, GrainMoment const& m) {
    state_[body] = {m.time, floor_of(dot(m.position, e_.along) / e_.bin), {}};
    pass(body, place_of(m.position));
    speed(body, 0, norm(m.velocity));
  }

  void leg(GrainLeg const& leg) {
    pass_cells(leg);
    pass_screens(leg);
    if (!leg.leaves) sample_speeds(leg);
  }

 private:
  struct OfBody {
    double release = 0;  // [s]
    int screen = 0;      // the farthest one it has come through
    std::set<CellPlace> passed;
  };

  Collected& group(int body) { return collected_[e_.grain[input_.grain[body]].group]; }

  CellPlace place_of(Vec3 x) const {
    return {floor_of(dot(x, e_.along) / e_.bin), floor_of(dot(x, e_.across) / e_.bin)};
  }

  void pass(int body, CellPlace place) {
    if (state_[body].passed.insert(place).second) ++group(body).cell[place].passed;
  }

  // The straight line is cut at the borders of the cells; the middle of each piece says which cell it is.
  void pass_cells(GrainLeg const& leg) {
    std::vector<double> cut{0, 1};
    for (Vec3 const& axis : {e_.along, e_.across}) {
      double const a = dot(leg.from.position, axis) / e_.bin, b = dot(leg.to.position, axis) / e_.bin;
      for (int k = floor_of(std::min(a, b)) + 1; k <= std::max(a, b); ++k) cut.push_back((k - a) / (b - a));
    }
    std::sort(cut.begin(), cut.end());
    for (std::size_t i = 0; i + 1 < cut.size(); ++i)
      if (cut[i + 1] > cut[i])
        pass(leg.body,
             place_of(leg.from.position + (leg.to.position - leg.from.position) * (0.5 * (cut[i] + cut[i + 1]))));
  }

  void pass_screens(GrainLeg const& leg) {
    double const a = dot(leg.from.position, e_.along) / e_.bin, b = dot(leg.to.position, e_.along) / e_.bin;
    int& reached = state_[leg.body].screen;
    for (; reached + 1 <= b; ++reached) {
      double const f = (reached + 1 - a) / (b - a);
      group(leg.body).energy[reached + 1].push_back(leg.energy(f));
      group(leg.body).rotation[reached + 1].push_back(leg.rotation(f));
    }
  }

  void speed(int body, int moment, double value) {
    std::vector<std::vector<double>>& all = group(body).speed;
    if (static_cast<int>(all.size()) <= moment) all.resize(moment + 1);
    all[moment].push_back(value);
  }

  void sample_speeds(GrainLeg const& leg) {
    double const release = state_[leg.body].release;
    // A frame is written by the first step at or after its time, which rounding may put just before it.
    auto const index = [&](double time) { return floor_of((time - release) / e_.every + 1e-6); };
    for (int k = index(leg.from.time) + 1; k <= index(leg.to.time); ++k) {
      double const f = (release + k * e_.every - leg.from.time) / (leg.to.time - leg.from.time);
      speed(leg.body, k, leg.speed(std::clamp(f, 0.0, 1.0)));
    }
  }

  Input const& input_;
  Envelopes const& e_;
  std::vector<Collected>& collected_;
  std::vector<OfBody> state_;
};

void count_ends(Envelopes const& e, int index, Collected& collected, EnvelopeGroup& group) {
  std::vector<double> run_out;
  std::set<std::pair<int, int>> replicas;
  double sum = 0, square = 0;
  std::map<int, EnvelopeGroup::Bin> bins;
  for (GrainWay const& way : e.grain) {
    if (way.group != index) continue;
    run_out.push_back(way.run_out);
    replicas.insert({way.file, way.replica});
    sum += way.sideways, square += way.sideways * way.sideways;
    group.widest = std::max(group.widest, std::abs(way.sideways));
    EnvelopeGroup::Cell& cell =
        collected.cell[{floor_of(dot(way.end, e.along) / e.bin), floor_of(dot(way.end, e.across) / e.bin)}];
    EnvelopeGroup::Bin& bin = bins[floor_of(way.run_out / e.bin)];
    ++(way.fate == Fate::left ? cell.left : cell.stopped);
    ++(way.fate == Fate::left ? bin.left : bin.stopped);
  }
  group.grains = static_cast<int>(run_out.size());
  group.replicas = static_cast<int>(replicas.size());
  double const n = group.grains;
  group.sideways = n > 1 ? std::sqrt(std::max(0.0, (square - sum * sum / n) / (n - 1))) : 0;
  std::sort(run_out.begin(), run_out.end());
  if (!bins.empty())
    for (int k = bins.begin()->first; k <= bins.rbegin()->first; ++k) {
      EnvelopeGroup::Bin bin = bins[k];
      bin.from = k * e.bin;
      auto const beyond = run_out.end() - std::lower_bound(run_out.begin(), run_out.end(), bin.from);
      bin.beyond = static_cast<double>(beyond) / n;
      group.bin.push_back(bin);
    }
  group.run_out = spread_of(std::move(run_out));
}

double mean_of(std::vector<double> const& sample) {
  double sum = 0;
  for (double const x : sample) sum += x;
  return sum / static_cast<double>(sample.size());
}

EnvelopeGroup finished(Envelopes const& e, int index, Collected& collected) {
  EnvelopeGroup group = e.group[index];
  count_ends(e, index, collected, group);
  for (auto& [place, cell] : collected.cell) {
    cell.along = (place.first + 0.5) * e.bin, cell.across = (place.second + 0.5) * e.bin;
    group.cell.push_back(cell);
  }
  for (auto& [k, energy] : collected.energy)
    group.screen.push_back({k * e.bin, spread_of(energy), mean_of(collected.rotation[k])});
  for (std::size_t k = 0; k < collected.speed.size(); ++k)
    group.moment.push_back({static_cast<double>(k) * e.every, spread_of(collected.speed[k])});
  return group;
}

}  // namespace

char const* to_string(Fate fate) { return fate == Fate::left ? "left" : fate == Fate::moving ? "moving" : "stopped"; }

SampleSpread spread_of(std::vector<double> sample) {
  if (sample.empty()) return {0, nothing, nothing, nothing, nothing};
  std::sort(sample.begin(), sample.end());
  auto const at = [&](double share) {
    double const place = share * static_cast<double>(sample.size() - 1);
    auto const k = static_cast<std::size_t>(place);
    double const next = sample[std::min(k + 1, sample.size() - 1)];
    return sample[k] + (place - static_cast<double>(k)) * (next - sample[k]);
  };
  return {static_cast<int>(sample.size()), mean_of(sample), at(0.05), at(0.95), sample.back()};
}

Envelopes measure_envelopes(std::vector<fs::path> const& results, EnvelopeOptions const& options) {
  if (options.bin < 0 || !std::isfinite(options.bin))
    throw InputError({fmt::format("bin {}: must be a positive length [m]", options.bin)});
  std::vector<Input> inputs = open_all(results, options.recover);
  Envelopes out;
  set_directions(options, inputs[0].scene, out);
  name_groups(inputs, out);
  for (std::size_t k = 0; k < inputs.size(); ++k) read_ways(static_cast<int>(k), inputs[k], out);
  double longest = 0;
  for (GrainWay const& way : out.grain) longest = std::max(longest, std::abs(way.run_out));
  out.bin = options.bin > 0 ? options.bin : longest > 0 ? round_number(longest / bins_on_the_way) : 1;
  out.every = inputs[0].scene.every;

  std::vector<Collected> collected(out.group.size());
  for (Input const& input : inputs) {
    LegCounter counter(input, out, collected);
    walk_legs(
        *input.reader, input.scene.gravity, [&](int body, GrainMoment const& m) { counter.release(body, m); },
        [&](GrainLeg const& leg) { counter.leg(leg); });
  }
  for (std::size_t g = 0; g < collected.size(); ++g) out.group[g] = finished(out, static_cast<int>(g), collected[g]);
  return out;
}

}  // namespace scree
