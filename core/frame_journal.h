// frame_journal.h: frames and ledger rows of a run in progress, kept so that nothing that was written can be lost.
// A working file: results.h5.partial is one HDF5 file, which a kill in the middle of a write may leave unreadable; here
// every record has a CRC and only the last can be torn. Same machine, same version: not for exchange.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "core/results.h"

namespace scree {

// Reads from the start, record by record.
class JournalReader {
 public:
  explicit JournalReader(std::filesystem::path const& file);  // an absent file has no records
  ~JournalReader();
  JournalReader(JournalReader const&) = delete;
  JournalReader& operator=(JournalReader const&) = delete;
  // False at the end, or at a record that is torn.
  bool next(Frame& frame, LedgerRow& row);
  std::int64_t offset() const { return offset_; }  // end of the last whole record read

 private:
  std::FILE* file_ = nullptr;
  std::int64_t offset_ = 0, size_ = 0;
};

class JournalWriter {
 public:
  // Goes on behind the first `keep` bytes, the rest is cut off. Throws std::system_error.
  JournalWriter(std::filesystem::path const& file, std::int64_t keep);
  ~JournalWriter();
  JournalWriter(JournalWriter const&) = delete;
  JournalWriter& operator=(JournalWriter const&) = delete;
  void append(Frame const& frame, LedgerRow const& row);
  void sync();  // what was appended is on the disk after this

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace scree
