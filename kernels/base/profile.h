// profile.h: wall time and work per named stage.
// Names are "stage/what"; a stage's time is the sum over its launches. Not thread-safe: the host thread only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace scree {

class Profile {
 public:
  struct Entry {
    std::string name;
    double seconds = 0;      // wall time [s]
    std::int64_t calls = 0;  // launches
    std::int64_t items = 0;  // loop items (queries, pairs, bodies ...)
  };

  void add(char const* name, double seconds, std::int64_t items);
  std::vector<Entry> const& entries() const { return entries_; }  // in order of first use
  void clear() { entries_.clear(); }

 private:
  std::vector<Entry> entries_;
  std::vector<char const*> keys_;  // pointer identity first: names are literals
};

// Times its own lifetime into `profile` (nullptr: does nothing).
class ScopedTimer {
 public:
  ScopedTimer(Profile* profile, char const* name, std::int64_t items)
      : profile_(profile), name_(name), items_(items), start_(std::chrono::steady_clock::now()) {}
  ~ScopedTimer() {
    if (profile_)
      profile_->add(name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), items_);
  }
  ScopedTimer(ScopedTimer const&) = delete;
  ScopedTimer& operator=(ScopedTimer const&) = delete;

 private:
  Profile* profile_;
  char const* name_;
  std::int64_t items_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace scree
