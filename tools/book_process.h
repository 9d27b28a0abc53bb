// book_process.h: scree-book as a process: which entries it has, and one entry run by itself, so that a crash of one
// loses no other and has a name.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

// The program: $SCREE_BOOK, else scree-book beside this program. Throws std::invalid_argument when it is not there.
std::filesystem::path find_book();

// Full names of its entries, "Validation.Row5SphereSlidesThenRolls". Throws std::runtime_error when it does not run.
std::vector<std::string> book_entries(std::filesystem::path const& book);

// Of `entries` those that a word names: a part ("validation"), a number ("5", "7a": names that go on with "Row7a" and a
// capital), or any piece of the name; case does not matter.
std::vector<std::string> entries_named(std::vector<std::string> const& entries, std::string const& word);

// Where one entry leaves what it measured and what it said.
struct EntryFiles {
  std::filesystem::path rows, curves, said;
};

// Starts one entry. Throws std::system_error.
pid_t start_entry(std::filesystem::path const& book, std::string const& entry, EntryFiles const& files, bool full);

// What became of it, from its wait status and what it said: "" when its test passed or was skipped, "its test failed",
// "killed by signal 11 (...)" ...
std::string end_of_entry(int wait_status, std::string const& said);

}  // namespace scree
