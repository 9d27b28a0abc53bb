// scree_validate.cpp: `scree validate`: the book, an entry a process; its table, CSV files and page of plots.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <thread>

#include "core/case.h"
#include "shapes/whole_file.h"
#include "tools/book_process.h"
#include "tools/book_table.h"
#include "tools/plot_script.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string read_text(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> choose(std::vector<std::string> const& entries, std::vector<std::string> const& words) {
  if (words.empty()) return entries;
  std::set<std::string> chosen;
  for (std::string const& word : words) {
    std::vector<std::string> const named = entries_named(entries, word);
    if (named.empty())
      throw InputError({fmt::format("the book has no entry '{}'; it has\n  {}", word, fmt::join(entries, "\n  "))});
    chosen.insert(named.begin(), named.end());
  }
  std::vector<std::string> in_order;
  std::copy_if(entries.begin(), entries.end(), std::back_inserter(in_order),
               [&](std::string const& e) { return chosen.count(e) > 0; });
  return in_order;
}

struct Outcome {
  std::vector<BookRow> rows;
  std::string curves, said;
  std::string trouble;  // as end_of_entry says it; "" when all is well
  double seconds = 0;
};

// What the process left. A crash, or a failure that no row tells of, becomes a row, so that no file hides it.
Outcome collect(std::string const& entry, EntryFiles const& files, int status, double seconds) {
  Outcome out;
  out.said = read_text(files.said);
  out.curves = read_text(files.curves);
  out.seconds = seconds;
  out.trouble = end_of_entry(status, out.said);
  try {
    out.rows = read_book_rows(files.rows);
  } catch (std::runtime_error const& error) {  // cut off in the middle of a line
    if (out.trouble.empty()) out.trouble = error.what();
  }
  bool const told = std::any_of(out.rows.begin(), out.rows.end(), [](BookRow const& r) { return !r.passed; });
  if (!out.trouble.empty() && !told) {
    BookRow const row{.part = "book",
                      .id = entry,
                      .title = "comes to its end",
                      .figure = out.trouble + "; its words are in book.log",
                      .unit = "",
                      .bound = "at_most",
                      .measured = 1,
                      .source = "the book",
                      .seconds = seconds};
    out.rows.push_back(row);
  }
  return out;
}

// Entries in any order, up to `at_once` processes; what each left, in the order of the list.
std::vector<Outcome> run_entries(fs::path const& book, std::vector<std::string> const& entries, fs::path const& folder,
                                 bool full, int at_once) {
  struct Running {
    std::size_t entry;
    EntryFiles files;
    Clock::time_point start;
  };
  std::vector<Outcome> outcome(entries.size());
  std::map<pid_t, Running> running;
  std::size_t next = 0, done = 0;
  while (done < entries.size()) {
    if (next < entries.size() && running.size() < static_cast<std::size_t>(at_once)) {
      auto const file = [&](char const* kind) { return folder / fmt::format("{}.{}", next, kind); };
      Running const started{next, {file("rows"), file("curves"), file("said")}, Clock::now()};
      running.emplace(start_entry(book, entries[next], started.files, full), started);
      ++next;
      continue;
    }
    int status = 0;
    pid_t const ended = ::waitpid(-1, &status, 0);
    auto const found = running.find(ended);
    if (found == running.end()) continue;
    Running const r = found->second;
    running.erase(found);
    Outcome& out = outcome[r.entry] = collect(entries[r.entry], r.files, status, since(r.start));
    ++done;
    // An entry without figures is one that only its long variant has.
    char const* const verdict = !out.trouble.empty() ? "FAIL" : out.rows.empty() ? "long" : "pass";
    fmt::print("[{}/{}] {} {:6.1f} s  {}{}\n", done, entries.size(), verdict, out.seconds, entries[r.entry],
               out.trouble.empty() ? "" : ": " + out.trouble);
    std::fflush(stdout);
  }
  return outcome;
}

}  // namespace

int validate_command(ValidateArguments const& a) {
  fs::path const book = find_book();
  std::vector<std::string> const all = book_entries(book);
  if (a.list) {
    for (std::string const& entry : all) fmt::print("{}\n", entry);
    return exit_ok;
  }
  std::vector<std::string> const entries = choose(all, a.names);
  fs::create_directories(a.output);
  fs::path const parts = a.output / "entries";  // of the processes, gone at the end
  fs::remove_all(parts);
  fs::create_directory(parts);
  auto const start = Clock::now();
  int const cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<Outcome> const outcome = run_entries(book, entries, parts, a.full, a.threads > 0 ? a.threads : cores);
  fs::remove_all(parts);

  std::string rows_text = book_rows_header, curves = book_curves_header, said;
  std::vector<BookRow> rows;
  std::size_t bad_entries = 0;
  for (Outcome const& out : outcome) {
    for (BookRow const& r : out.rows) rows.push_back(r), rows_text += book_row_line(r);
    curves += out.curves;
    said += out.said;
    bad_entries += !out.trouble.empty();
  }
  replace_whole_file(a.output / "validation.csv", rows_text);
  replace_whole_file(a.output / "curves.csv", curves);
  replace_whole_file(a.output / "book.log", said);
  fmt::print("{}\n", book_table(rows));
  auto const bad_rows = std::count_if(rows.begin(), rows.end(), [](BookRow const& r) { return !r.passed; });
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (!outcome[i].trouble.empty()) fmt::print("FAIL {}: {}\n", entries[i], outcome[i].trouble);
  fmt::print("{} entries, {} figures: {} FAIL, {} figures outside; {:.0f} s\n", entries.size(), rows.size(),
             bad_entries, bad_rows, since(start));
  fmt::print("{}: validation.csv, curves.csv, book.log\n", a.output.string());
  std::string const trouble = run_plot_script(plot_book_text, {a.output.string()});
  if (trouble.empty())
    fmt::print("page of plots: {}\n", (a.output / "validation.html").string());
  else
    fmt::print("no page of plots: {}\n", trouble);
  return bad_entries > 0 ? exit_watch : exit_ok;
}

}  // namespace scree
