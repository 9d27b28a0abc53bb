// fuzz_journal.cpp: the frame journal: whole files, and the content of records behind their CRC.
// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <vector>

#include "core/frame_journal.h"
#include "tests/fuzz/fuzz_input.h"

using namespace scree;

namespace {

void read_as_file(std::uint8_t const* data, std::size_t size) {
  int const memory = ::memfd_create("journal", 0);
  fuzz::must(memory >= 0 && ::write(memory, data, size) == static_cast<ssize_t>(size), "a file in memory is written");
  {
    JournalReader reader("/proc/self/fd/" + std::to_string(memory));
    Frame frame;
    LedgerRow row;
    while (reader.next(frame, row))
      fuzz::must(reader.offset() <= static_cast<std::int64_t>(size), "offsets are inside");
  }
  ::close(memory);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  read_as_file(data, size);
  std::vector<char> const payload(data, data + size);
  Frame frame;
  LedgerRow row;
  if (decode_record(payload, frame, row)) fuzz::must(encode_record(frame, row) == payload, "a record writes back");
  return 0;
}
