// frame_journal.cpp: see frame_journal.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/frame_journal.h"

#include <zlib.h>

#include <cstring>
#include <string>
#include <type_traits>

namespace scree {
namespace {

struct RecordHead {
  std::uint64_t magic, length;  // of the payload [bytes]
  std::uint64_t crc;            // of the payload
};
std::uint64_t constexpr record_magic = 0x314d524645455243u;  // "CREEFRM1"

std::uint64_t checksum(std::vector<char> const& bytes) {
  return crc32_z(0, reinterpret_cast<Bytef const*>(bytes.data()), bytes.size());
}

void put(std::vector<char>& out, void const* data, std::size_t count) {
  out.insert(out.end(), static_cast<char const*>(data), static_cast<char const*>(data) + count);
}
template <class T>
void put(std::vector<char>& out, T const& v) {
  put(out, &v, sizeof(v));
}
template <class T>
void put(std::vector<char>& out, std::vector<T> const& v) {
  put(out, std::uint64_t{v.size()});
  if (!v.empty()) put(out, v.data(), v.size() * sizeof(T));
}

// The payload back, part by part; `good` turns false where it is too short.
struct Parts {
  std::vector<char> const& bytes;
  std::size_t at = 0;
  bool good = true;

  void get(void* to, std::size_t count) {
    good = good && count <= bytes.size() - at;
    if (!good) return;
    if (count > 0) std::memcpy(to, bytes.data() + at, count);
    at += count;
  }
  template <class T>
  void get(std::vector<T>& v) {
    std::uint64_t n = 0;
    get(&n, sizeof(n));
    good = good && n <= (bytes.size() - at) / sizeof(T);
    if (!good) return;
    v.resize(n);
    get(static_cast<void*>(v.data()), n * sizeof(T));
  }
};

}  // namespace

std::vector<char> encode_record(Frame const& frame, LedgerRow const& row) {
  std::vector<char> payload;
  put(payload, frame.time);
  put(payload, frame.step);
  put(payload, frame.position);
  put(payload, frame.orientation);
  put(payload, frame.velocity);
  put(payload, frame.spin);
  put(payload, frame.activity);
  put(payload, frame.wall_position);
  put(payload, frame.wall_orientation);
  put(payload, row);
  return payload;
}

bool decode_record(std::vector<char> const& payload, Frame& frame, LedgerRow& row) {
  Parts parts{payload};
  parts.get(&frame.time, sizeof(frame.time));
  parts.get(&frame.step, sizeof(frame.step));
  parts.get(frame.position);
  parts.get(frame.orientation);
  parts.get(frame.velocity);
  parts.get(frame.spin);
  parts.get(frame.activity);
  parts.get(frame.wall_position);
  parts.get(frame.wall_orientation);
  static_assert(std::is_trivially_copyable_v<LedgerRow>);
  parts.get(&row, sizeof(row));
  return parts.good && parts.at == payload.size();
}

JournalReader::JournalReader(std::filesystem::path const& file) : file_(std::fopen(file.c_str(), "rb")) {
  std::error_code error;
  auto const size = std::filesystem::file_size(file, error);
  if (!error) size_ = static_cast<std::int64_t>(size);
}

JournalReader::~JournalReader() {
  if (file_) std::fclose(file_);
}

bool JournalReader::next(Frame& frame, LedgerRow& row) {
  RecordHead head{};
  if (!file_ || std::fread(&head, sizeof(head), 1, file_) != 1 || head.magic != record_magic) return false;
  if (head.length > static_cast<std::uint64_t>(size_)) return false;
  std::vector<char> payload(head.length);
  if (std::fread(payload.data(), 1, payload.size(), file_) != payload.size() || checksum(payload) != head.crc)
    return false;
  if (!decode_record(payload, frame, row)) return false;
  offset_ += static_cast<std::int64_t>(sizeof(head) + payload.size());
  return true;
}

void JournalWriter::append(Frame const& frame, LedgerRow const& row) {
  std::vector<char> const payload = encode_record(frame, row);
  RecordHead const head{record_magic, payload.size(), checksum(payload)};
  std::string record(reinterpret_cast<char const*>(&head), sizeof(head));
  record.append(payload.data(), payload.size());
  file_.append(record);
}

}  // namespace scree
