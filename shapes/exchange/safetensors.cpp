// safetensors.cpp: see safetensors.h. Layout: 8 bytes header length (little-endian), JSON header, tensors back to back.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/exchange/safetensors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "shapes/whole_file.h"

namespace scree {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "safetensors are little-endian");

std::uint64_t constexpr longest_header = 100'000'000;  // the format's own limit
std::int64_t constexpr most_values = std::int64_t{1} << 31;
char constexpr metadata_key[] = "__metadata__";

[[noreturn]] void fail(std::string const& what) { throw std::runtime_error(what); }

float from_half(std::uint16_t bits) {
  int const exponent = bits >> 10 & 31, fraction = bits & 1023;
  float const sign = bits >> 15 ? -1.0F : 1.0F;
  if (exponent == 31) return fraction ? NAN : sign * INFINITY;
  return exponent == 0 ? sign * std::ldexp(static_cast<float>(fraction), -24)
                       : sign * std::ldexp(static_cast<float>(fraction + 1024), exponent - 25);
}

template <class T>
T load(char const* at) {
  T value;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

// Out of a float's range the cast is undefined.
float from_double(double value) {
  return std::abs(value) > std::numeric_limits<float>::max() ? INFINITY : static_cast<float>(value);
}

struct Type {
  char const* name;
  int bytes;
  float (*read)(char const*);
};
Type constexpr types[] = {
    {"F32", 4, [](char const* at) { return load<float>(at); }},
    {"F64", 8, [](char const* at) { return from_double(load<double>(at)); }},
    {"F16", 2, [](char const* at) { return from_half(load<std::uint16_t>(at)); }},
    {"BF16", 2, [](char const* at) { return std::bit_cast<float>(std::uint32_t{load<std::uint16_t>(at)} << 16); }},
};

// The standard parser keeps the last of two equal keys; a file that says two things is refused.
json parse_header(std::string const& text) {
  std::vector<std::set<std::string>> open;
  std::string twice;
  auto const watch = [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::object_end) open.pop_back();
    if (event == json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second)
      twice = value.get<std::string>();
    return true;
  };
  json header;
  try {
    header = json::parse(text, watch);
  } catch (json::exception const& e) {
    fail(std::string("its header is no JSON: ") + e.what());
  }
  if (!twice.empty()) fail("its header names '" + twice + "' twice");
  if (!header.is_object()) fail("its header is no JSON object");
  return header;
}

struct Entry {
  std::string name;
  Type const* type = nullptr;
  std::vector<std::int64_t> shape;
  std::uint64_t begin = 0, end = 0;
};

std::uint64_t offset(json const& value, std::string const& name) {
  if (!value.is_number_unsigned()) fail("tensor '" + name + "': an offset is no whole number");
  return value.get<std::uint64_t>();
}

Entry read_entry(std::string const& name, json const& j) {
  auto const wrong = [&](std::string const& what) { fail("tensor '" + name + "': " + what); };
  Entry entry;
  entry.name = name;
  if (!j.is_object()) wrong("its entry is no JSON object");
  if (!j.contains("dtype") || !j["dtype"].is_string()) wrong("dtype is missing");
  for (Type const& type : types)
    if (j["dtype"] == type.name) entry.type = &type;
  if (!entry.type) wrong("dtype " + j["dtype"].get<std::string>() + " is not read (F32, F64, F16, BF16 are)");
  if (!j.contains("shape") || !j["shape"].is_array()) wrong("shape is missing");
  std::int64_t count = 1;
  for (json const& extent : j["shape"]) {
    if (!extent.is_number_unsigned() || extent.get<std::uint64_t>() > std::uint64_t(most_values))
      wrong("shape has an entry that is no size");
    entry.shape.push_back(extent.get<std::int64_t>());
    if (entry.shape.back() > 0 && count > most_values / entry.shape.back()) wrong("shape is too large");
    count *= entry.shape.back();
  }
  if (!j.contains("data_offsets") || !j["data_offsets"].is_array() || j["data_offsets"].size() != 2)
    wrong("data_offsets must be two numbers");
  entry.begin = offset(j["data_offsets"][0], name);
  entry.end = offset(j["data_offsets"][1], name);
  std::uint64_t const bytes = static_cast<std::uint64_t>(count) * static_cast<std::uint64_t>(entry.type->bytes);
  if (entry.end < entry.begin || entry.end - entry.begin != bytes)
    wrong("data_offsets hold " + std::to_string(entry.end - entry.begin) + " bytes, its shape takes " +
          std::to_string(bytes));
  return entry;
}

std::vector<Entry> read_entries(json const& header, std::uint64_t data_bytes) {
  std::vector<Entry> entries;
  for (auto const& [name, value] : header.items())
    if (name != metadata_key) entries.push_back(read_entry(name, value));
  std::sort(entries.begin(), entries.end(), [](Entry const& a, Entry const& b) {
    return std::pair{a.begin, a.end} < std::pair{b.begin, b.end};
  });
  std::uint64_t at = 0;
  for (Entry const& e : entries) {
    if (e.begin != at)
      fail("tensor '" + e.name + "' begins at byte " + std::to_string(e.begin) +
           " of the data, the one before ends at " + std::to_string(at) +
           (e.begin < at ? ": they overlap" : ": there is a hole"));
    at = e.end;
  }
  if (at != data_bytes)
    fail("its tensors take " + std::to_string(at) + " bytes, the file holds " + std::to_string(data_bytes) +
         (at > data_bytes ? ": it is cut short" : ": there is something behind them"));
  return entries;
}

FloatTensor convert(Entry const& entry, char const* data) {
  FloatTensor tensor;
  tensor.shape = entry.shape;
  for (std::uint64_t at = entry.begin; at < entry.end; at += static_cast<std::uint64_t>(entry.type->bytes)) {
    float const value = entry.type->read(data + at);
    if (!std::isfinite(value)) fail("tensor '" + entry.name + "' has a NaN or infinite number");
    tensor.value.push_back(value);
  }
  return tensor;
}

}  // namespace

TensorFile parse_safetensors(std::string const& bytes) {
  if (bytes.size() < 8) fail("is too short for a safetensors file");
  std::uint64_t const length = load<std::uint64_t>(bytes.data());
  if (length > longest_header || length > bytes.size() - 8)
    fail("its header should be " + std::to_string(length) + " bytes long: no safetensors file, or cut short");
  json const header = parse_header(bytes.substr(8, length));
  TensorFile content;
  if (header.contains(metadata_key)) {
    if (!header[metadata_key].is_object()) fail("__metadata__ is no JSON object");
    for (auto const& [key, value] : header[metadata_key].items()) {
      if (!value.is_string()) fail("__metadata__ '" + key + "' is no text");
      content.metadata[key] = value.get<std::string>();
    }
  }
  char const* const data = bytes.data() + 8 + length;
  for (Entry const& entry : read_entries(header, bytes.size() - 8 - length))
    content.tensor[entry.name] = convert(entry, data);
  return content;
}

TensorFile read_safetensors(std::filesystem::path const& file) {
  std::string const bytes = read_whole_file(file);
  try {
    return parse_safetensors(bytes);
  } catch (std::runtime_error const& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

void write_safetensors(std::filesystem::path const& file, TensorFile const& content, bool overwrite) {
  json header = json::object();
  if (!content.metadata.empty()) header[metadata_key] = content.metadata;
  std::uint64_t at = 0;
  std::string data;
  for (auto const& [name, tensor] : content.tensor) {
    std::uint64_t count = 1;
    for (std::int64_t extent : tensor.shape) count *= static_cast<std::uint64_t>(extent);
    if (count != tensor.value.size()) throw std::invalid_argument("tensor '" + name + "' does not fill its shape");
    header[name] = {{"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {at, at + 4 * count}}};
    at += 4 * count;
    data.append(reinterpret_cast<char const*>(tensor.value.data()), 4 * tensor.value.size());
  }
  std::string text;
  try {
    text = header.dump();
  } catch (json::exception const&) {
    throw std::runtime_error(file.string() + ": not written: a name or text is not UTF-8");
  }
  text.resize((text.size() + 7) / 8 * 8, ' ');  // the format wants the tensors aligned
  std::uint64_t const length = text.size();
  std::string const bytes = std::string(reinterpret_cast<char const*>(&length), sizeof(length)) + text + data;
  write_whole_file(file, bytes, overwrite);
}

}  // namespace scree
