// frame_journal.h: frames and ledger rows of a run in progress, kept so that nothing that was written can be lost.
// A working file: results.h5.partial is one HDF5 file, which a kill in the middle of a write may leave unreadable; here
// every record has a CRC and only the last can be torn. Same machine, same version: not for exchange.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "core/appended_file.h"
#include "core/results.h"

namespace scree {

// The content of a record, without its head and CRC; and back: false where it is none, the outputs are then undefined.
std::vector<char> encode_record(Frame const& frame, LedgerRow const& row);
bool decode_record(std::vector<char> const& payload, Frame& frame, LedgerRow& row);

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
  // Goes on behind the first `keep` bytes, the rest is cut off. All throw std::system_error.
  JournalWriter(std::filesystem::path const& file, std::int64_t keep) : file_(file, keep) {}
  void append(Frame const& frame, LedgerRow const& row);
  void sync() { file_.sync(); }  // what was appended is on the disk after this

 private:
  AppendedFile file_;
};

}  // namespace scree
