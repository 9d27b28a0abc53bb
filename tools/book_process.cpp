// book_process.cpp: see book_process.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/book_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

extern char** environ;

namespace scree {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// Place of an entry in its part: "Row7aName" by number and letter, others behind them as they are.
std::pair<int, char> place_of(std::string const& entry) {
  std::size_t const row = entry.find(".Row");
  if (row == std::string::npos) return {std::numeric_limits<int>::max(), 'a'};
  std::size_t at = row + 4;
  int number = 0;
  for (; at < entry.size() && std::isdigit(static_cast<unsigned char>(entry[at])); ++at)
    number = 10 * number + entry[at] - '0';
  bool const letter = at < entry.size() && std::islower(static_cast<unsigned char>(entry[at]));
  return {number, letter ? entry[at] : ' '};
}

}  // namespace

fs::path find_book() {
  if (char const* named = std::getenv("SCREE_BOOK")) {
    if (fs::is_regular_file(named)) return named;
    throw std::invalid_argument(fmt::format("$SCREE_BOOK is {}, which is not there", named));
  }
  std::error_code error;
  fs::path const beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "scree-book";
  if (!error && fs::is_regular_file(beside)) return beside;
  throw std::invalid_argument(
      "the validation book, scree-book, does not lie beside this program: it is built with the tests "
      "(-DSCREE_TESTS=ON, "
      "target scree_book); $SCREE_BOOK may name another place");
}

std::vector<std::string> book_entries(fs::path const& book) {
  std::string const command = "'" + book.string() + "' --gtest_list_tests 2>/dev/null";
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error(book.string() + " could not be started");
  std::string text;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;) text.append(buffer, n);
  int const status = ::pclose(pipe);
  // "Suite.\n  Test\n  Test  # GetParam() = 1\n"
  std::vector<std::string> entries;
  std::string suite;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t const end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    at = end + 1;
    line = line.substr(0, line.find('#'));
    line.erase(line.find_last_not_of(' ') + 1);
    bool const test = line.rfind("  ", 0) == 0;
    if (!test && !line.empty() && line.back() == '.') suite = line;
    if (test && !suite.empty() && line.find("DISABLED_") == std::string::npos)
      entries.push_back(suite + line.substr(2));
  }
  if (status != 0 || entries.empty())
    throw std::runtime_error(fmt::format("{} does not list its entries: is it the validation book?", book.string()));
  auto const part = [](std::string const& entry) { return entry.substr(0, entry.find('.')); };
  for (auto first = entries.begin(); first != entries.end();) {  // parts as they come, rows by number
    auto const last = std::find_if(first, entries.end(), [&](std::string const& e) { return part(e) != part(*first); });
    std::stable_sort(first, last, [](auto const& a, auto const& b) { return place_of(a) < place_of(b); });
    first = last;
  }
  return entries;
}

std::vector<std::string> entries_named(std::vector<std::string> const& entries, std::string const& word) {
  std::string const wanted = lower(word);
  bool const number = !word.empty() && std::isdigit(static_cast<unsigned char>(word[0]));
  std::vector<std::string> out;
  for (std::string const& entry : entries) {
    std::string const name = lower(entry);
    std::size_t const row = name.find(".row" + wanted);
    std::size_t const after = row + 4 + wanted.size();
    bool const of_number =
        row != std::string::npos && (after >= entry.size() || std::isupper(static_cast<unsigned char>(entry[after])));
    bool const of_part = name.rfind(wanted + ".", 0) == 0;
    if (number ? of_number : of_part || name.find(wanted) != std::string::npos) out.push_back(entry);
  }
  return out;
}

pid_t start_entry(fs::path const& book, std::string const& entry, EntryFiles const& files, bool full) {
  std::vector<std::string> set = {"SCREE_BOOK_CSV=" + files.rows.string(), "SCREE_BOOK_CURVES=" + files.curves.string(),
                                  "OMP_WAIT_POLICY=passive"};
  if (full) set.push_back("SCREE_BOOK_FULL=1");
  std::vector<char*> environment;
  for (std::string& s : set) environment.push_back(s.data());
  for (char** e = environ; *e; ++e)
    if (std::strncmp(*e, "SCREE_BOOK_", 11) != 0 && std::strncmp(*e, "GTEST_", 6) != 0) environment.push_back(*e);
  environment.push_back(nullptr);
  std::string program = book.string(), filter = "--gtest_filter=" + entry;
  char* const arguments[] = {program.data(), filter.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 1, files.said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t child = 0;
  int const error = ::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments, environment.data());
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), program + " could not be started");
  return child;
}

std::string end_of_entry(int status, std::string const& said) {
  if (WIFSIGNALED(status))
    return fmt::format("killed by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  // GoogleTest's own words tell whether the test came to its end: any library may call exit().
  auto const has = [&](char const* words) { return said.find(words) != std::string::npos; };
  int const code = WEXITSTATUS(status);
  if (code == 0 && (has("[       OK ]") || has("[  SKIPPED ]"))) return "";
  return code == 1 && has("[  FAILED  ]") ? "its test failed"
                                          : fmt::format("ended with exit code {} in the middle of its test", code);
}

}  // namespace scree
