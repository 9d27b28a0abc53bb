// checkpoint_content.cpp: see checkpoint_content.h. Names and shapes are listed in core/README.md.
// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint_content.h"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "core/results_hdf5.h"
#include "core/state_members.h"

namespace scree {
namespace {

using results_hdf5::read_array;
using results_hdf5::write_array;

// Arrays of these are written as they lie in memory, `inner` doubles each.
template <class T>
int constexpr inner = 0;
template <>
int constexpr inner<Vec3> = 3;
template <>
int constexpr inner<Quat> = 4;
template <>
int constexpr inner<Wrench> = 6;
static_assert(sizeof(Vec3) == 24 && sizeof(Quat) == 32 && sizeof(Wrench) == 48);
static_assert(sizeof(Activity) == 1 && sizeof(Pair) == 2 * sizeof(int));

// One overload a type of member; single numbers are arrays of one.
struct Write {
  hid_t at;

  template <class T>
  void operator()(char const* name, std::vector<T> const& v) const {
    if constexpr (inner < T >> 0)
      write_array(at, name, reinterpret_cast<double const*>(v.data()), {v.size(), hsize_t{inner<T>}});
    else
      write_array(at, name, v.data(), {v.size()});
  }
  void operator()(char const* name, std::vector<Activity> const& v) const {
    write_array(at, name, reinterpret_cast<std::uint8_t const*>(v.data()), {v.size()});
  }
  void operator()(char const* name, std::vector<Pair> const& v) const {
    write_array(at, name, reinterpret_cast<int const*>(v.data()), {v.size(), 2});
  }
  void operator()(char const* name, std::vector<Insertion> const& v) const {
    hdf5::Handle const group = hdf5::create_group(at, name);
    Write const to{group};
    std::vector<int> done;
    std::vector<std::int64_t> random, times;
    std::vector<double> since, seconds;
    for (Insertion const& in : v) {
      done.push_back(in.done);
      random.push_back(std::bit_cast<std::int64_t>(in.random));
      since.push_back(in.blocked_since);
      times.push_back(in.blocked_times);
      seconds.push_back(in.blocked_seconds);
    }
    to("done", done);
    to("random", random);
    to("blocked_since", since);
    to("blocked_times", times);
    to("blocked_seconds", seconds);
  }
  void operator()(char const* name, std::vector<Measurement> const& v) const {
    hdf5::Handle const group = hdf5::create_group(at, name);
    Write const to{group};
    std::vector<std::int64_t> next, samples;
    std::vector<double> last_time, memory, mean, squares, last;
    std::vector<int> memory_count, moments_count;
    for (Measurement const& m : v) {
      next.push_back(m.next);
      last_time.push_back(m.last_time);
      memory_count.push_back(static_cast<int>(m.memory.size()));
      memory.insert(memory.end(), m.memory.begin(), m.memory.end());
      moments_count.push_back(static_cast<int>(m.moments.size()));
      for (Moments const& k : m.moments) {
        samples.push_back(k.samples);
        mean.push_back(k.mean);
        squares.push_back(k.squares);
        last.push_back(k.last);
      }
    }
    to("next", next);
    to("last_time", last_time);
    to("memory_count", memory_count);
    to("memory", memory);
    to("moments_count", moments_count);
    to("samples", samples);
    to("mean", mean);
    to("squares", squares);
    to("last", last);
  }
  void operator()(char const* name, double v) const { write_array(at, name, &v, {1}); }
  void operator()(char const* name, std::int64_t v) const { write_array(at, name, &v, {1}); }
  void operator()(char const* name, bool v) const {
    std::uint8_t const byte = v;
    write_array(at, name, &byte, {1});
  }
};

struct Read {
  hid_t at;

  template <class T>
  void operator()(char const* name, std::vector<T>& v) const {
    if constexpr (inner < T >> 0) {
      std::vector<double> const flat = read_array<double>(at, name, {hsize_t{inner<T>}});
      v.resize(flat.size() / inner<T>);
      if (!flat.empty()) std::memcpy(static_cast<void*>(v.data()), flat.data(), flat.size() * sizeof(double));
    } else {
      v = read_array<T>(at, name);
    }
  }
  void operator()(char const* name, std::vector<Activity>& v) const {
    v.clear();
    for (std::uint8_t const a : read_array<std::uint8_t>(at, name)) {
      if (a > static_cast<std::uint8_t>(Activity::deleted))
        throw std::runtime_error("dataset 'activity' holds a number that is none of 0, 1, 2");
      v.push_back(static_cast<Activity>(a));
    }
  }
  void operator()(char const* name, std::vector<Pair>& v) const {
    std::vector<int> const flat = read_array<int>(at, name, {2});
    v.clear();
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2) v.push_back({flat[i], flat[i + 1]});
  }
  void operator()(char const* name, std::vector<Insertion>& v) const {
    hdf5::Handle const group = hdf5::open_group(at, name);
    auto const done = read_array<int>(group, "done");
    auto const random = read_array<std::int64_t>(group, "random"),
               times = read_array<std::int64_t>(group, "blocked_times");
    auto const since = read_array<double>(group, "blocked_since"),
               seconds = read_array<double>(group, "blocked_seconds");
    std::size_t const n = done.size();
    if (random.size() != n || times.size() != n || since.size() != n || seconds.size() != n)
      throw std::runtime_error("group 'insertion': lengths differ");
    v.clear();
    for (std::size_t i = 0; i < n; ++i)
      v.push_back({done[i], std::bit_cast<std::uint64_t>(random[i]), since[i], times[i], seconds[i]});
  }
  void operator()(char const* name, std::vector<Measurement>& v) const {
    hdf5::Handle const group = hdf5::open_group(at, name);
    auto const next = read_array<std::int64_t>(group, "next"), samples = read_array<std::int64_t>(group, "samples");
    auto const last_time = read_array<double>(group, "last_time"), memory = read_array<double>(group, "memory");
    auto const mean = read_array<double>(group, "mean"), squares = read_array<double>(group, "squares");
    auto const last = read_array<double>(group, "last");
    auto const memory_count = read_array<int>(group, "memory_count");
    auto const moments_count = read_array<int>(group, "moments_count");
    std::size_t const n = next.size(), quantities = samples.size();
    bool const same = last_time.size() == n && memory_count.size() == n && moments_count.size() == n &&
                      mean.size() == quantities && squares.size() == quantities && last.size() == quantities;
    std::size_t in_memory = 0, in_moments = 0;
    v.assign(same ? n : 0, {});
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i].next = next[i];
      v[i].last_time = last_time[i];
      for (int k = 0; k < memory_count[i] && in_memory < memory.size(); ++k) v[i].memory.push_back(memory[in_memory++]);
      for (int k = 0; k < moments_count[i] && in_moments < quantities; ++k, ++in_moments)
        v[i].moments.push_back({samples[in_moments], mean[in_moments], squares[in_moments], last[in_moments]});
    }
    if (!same || in_memory != memory.size() || in_moments != quantities)
      throw std::runtime_error("group 'measure': lengths differ");
  }
  void operator()(char const* name, double& v) const { v = one<double>(name); }
  void operator()(char const* name, std::int64_t& v) const { v = one<std::int64_t>(name); }
  void operator()(char const* name, bool& v) const { v = one<std::uint8_t>(name) != 0; }

  template <class T>
  T one(char const* name) const {
    std::vector<T> const v = read_array<T>(at, name);
    if (v.size() != 1) throw std::runtime_error("dataset '" + std::string(name) + "' is not one number");
    return v[0];
  }
};

template <class P, class Visit>
void for_each_member_of_pairs(P& p, Visit const& visit) {
  visit("pair", p.pair);
  visit("built_position", p.built_position);
  visit("built_orientation", p.built_orientation);
  visit("side", p.side);
  visit("energy_normal", p.energy_normal);
  visit("energy_tangential", p.energy_tangential);
  visit("energy_rolling", p.energy_rolling);
  visit("overlap", p.overlap);
}

template <class C, class Visit>
void for_each_member_of_run(C& c, Visit const& visit) {
  visit("at_rest", c.at_rest);
  visit("warned_of_share", c.warned_of_share);
  visit("output_frames", c.output.frames);
  visit("output_due", c.output.due);
  visit("output_every", c.output.every);
  visit("output_measures_bytes", c.output.measures_bytes);
  visit("output_contacts_bytes", c.output.contacts_bytes);
}

}  // namespace

void write_checkpoint_content(hid_t file, Checkpoint const& c) {
  hdf5::write_attribute(file, "format", std::string(checkpoint_format));
  hdf5::write_attribute(file, "version", std::int64_t{checkpoint_version});
  results_hdf5::write_text(file, "case", c.identity);
  Write{file}("inputs", std::bit_cast<std::int64_t>(c.inputs));
  hdf5::Handle const state = hdf5::create_group(file, "/state");
  hdf5::Handle const pairs = hdf5::create_group(file, "/pairs");
  hdf5::Handle const run = hdf5::create_group(file, "/run");
  for_each_member(c.state, Write{state});
  for_each_member_of_pairs(c.pairs, Write{pairs});
  for_each_member_of_run(c, Write{run});
}

Checkpoint read_checkpoint_content(hid_t file) {
  Checkpoint c;
  c.identity = results_hdf5::read_text(file, "case");
  c.inputs = std::bit_cast<std::uint64_t>(Read{file}.one<std::int64_t>("inputs"));
  hdf5::Handle const state = hdf5::open_group(file, "/state");
  hdf5::Handle const pairs = hdf5::open_group(file, "/pairs");
  hdf5::Handle const run = hdf5::open_group(file, "/run");
  for_each_member(c.state, Read{state});
  for_each_member_of_pairs(c.pairs, Read{pairs});
  for_each_member_of_run(c, Read{run});
  return c;
}

}  // namespace scree
