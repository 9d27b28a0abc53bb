// ply_file.cpp: see ply_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/ply_file.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "shapes/ply_header.h"
#include "shapes/text_lines.h"

namespace scree {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read and written as little-endian");

// Damaged files have integers beyond every integer type.
std::string digits_of(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

// The body's values in order, as doubles (exact for every PLY type). Knows where it is, for complaints.
class PlyValues {
 public:
  PlyValues(std::filesystem::path const& file, std::string const& bytes, PlyHeader const& header)
      : file_(file), bytes_(bytes), at_(header.body), line_(header.lines), ascii_(header.ascii) {}

  [[noreturn]] void fail(std::string const& what) const {
    if (ascii_) fail_file(file_, line_, what);
    fail_file(file_, *element_ + " " + std::to_string(row_) + ": " + what);
  }

  void begin_row(PlyElement const& element, int row) {
    element_ = &element.name, row_ = row;
    if (!ascii_) return;
    next_word_ = 0;
    if (!next_line())
      fail("the file ends before " + element.name + " " + std::to_string(row) + " of " + std::to_string(element.count));
  }

  double value(PlyType type) {
    if (!ascii_) return binary_value(type);
    if (next_word_ == word_.size()) fail("too few values for a " + *element_);
    std::string_view const word = word_[next_word_++];
    double const x = read_number(file_, line_, word);
    if (type < PlyType::float32 && x != std::floor(x)) fail("not an integer: " + std::string(word));
    return x;
  }

  int list_length(PlyType type) {
    double const length = value(type);
    // Each item takes a byte or more: a damaged length must not ask for memory.
    if (length < 0 || length > static_cast<double>(bytes_.size()))
      fail("a list of " + digits_of(length) + " items does not fit the file");
    return static_cast<int>(length);
  }

  void end_row() const {
    if (ascii_ && next_word_ != word_.size()) fail("too many values for a " + *element_);
  }

  // Blanks may follow the last row, nothing else.
  void end() {
    if (ascii_ && next_line()) fail("more rows than the header promises");
    if (!ascii_ && bytes_.find_first_not_of(" \r\n\t", at_) != std::string::npos)
      fail_file(file_, std::to_string(bytes_.size() - at_) + " bytes more than the header promises");
  }

 private:
  bool next_line() {
    word_.clear();
    while (word_.empty() && at_ < bytes_.size()) {
      std::size_t const end = std::min(bytes_.find('\n', at_), bytes_.size());
      word_ = words(std::string_view(bytes_).substr(at_, end - at_));
      at_ = end + 1;
      ++line_;
    }
    return !word_.empty();
  }

  template <class T>
  double take() {
    T x;
    if (at_ + sizeof(T) > bytes_.size()) fail("the file is cut short");
    std::memcpy(&x, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(x);
  }

  double binary_value(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>();
      case PlyType::uint8:
        return take<std::uint8_t>();
      case PlyType::int16:
        return take<std::int16_t>();
      case PlyType::uint16:
        return take<std::uint16_t>();
      case PlyType::int32:
        return take<std::int32_t>();
      case PlyType::uint32:
        return take<std::uint32_t>();
      case PlyType::float32:
        return take<float>();
      case PlyType::float64:
        return take<double>();
    }
    return 0;
  }

  std::filesystem::path const& file_;
  std::string const& bytes_;
  std::size_t at_;
  int line_;
  bool ascii_;
  std::vector<std::string_view> word_;  // of the current line
  std::size_t next_word_ = 0;
  std::string const* element_ = nullptr;
  int row_ = 0;
};

// One row: scalars by property; the items of list `wanted` (-1: none), others are skipped.
void read_row(PlyValues& values, PlyElement const& element, int wanted, std::vector<double>& scalar,
              std::vector<double>& list) {
  for (std::size_t k = 0; k < element.property.size(); ++k) {
    PlyProperty const& p = element.property[k];
    if (!p.is_list) {
      scalar[k] = values.value(p.type);
      continue;
    }
    int const length = values.list_length(p.count_type);
    if (static_cast<int>(k) == wanted) list.clear();
    for (int i = 0; i < length; ++i) {
      double const item = values.value(p.type);
      if (static_cast<int>(k) == wanted) list.push_back(item);
    }
  }
}

// Which properties hold the three components, -1 where one is missing.
std::array<int, 3> columns(PlyElement const& element, std::array<char const*, 3> const& name) {
  return {element.find(name[0]), element.find(name[1]), element.find(name[2])};
}

bool all_scalars(PlyElement const& element, std::array<int, 3> const& column) {
  for (int c : column)
    if (c < 0 || element.property[c].is_list) return false;
  return true;
}

Vec3 pick(std::vector<double> const& scalar, std::array<int, 3> const& column) {
  return {scalar[column[0]], scalar[column[1]], scalar[column[2]]};
}

void add_face(PlyValues const& values, std::vector<double> const& index, std::size_t vertices, PlyContent& content) {
  if (index.size() < 3) values.fail("a face needs three corners");
  for (double i : index)
    if (i < 0 || i >= static_cast<double>(vertices))
      values.fail("vertex " + digits_of(i) + " does not exist (there are " + std::to_string(vertices) + ", from 0)");
  for (std::size_t k = 2; k < index.size(); ++k)
    content.triangle.push_back(
        {static_cast<int>(index[0]), static_cast<int>(index[k - 1]), static_cast<int>(index[k])});
}

}  // namespace

PlyContent parse_ply(std::filesystem::path const& file, std::string const& bytes) {
  PlyHeader const header = parse_ply_header(file, bytes);
  PlyElement const* const vertices = header.find("vertex");
  if (!vertices) fail_file(file, "has no element 'vertex'");
  auto const position = columns(*vertices, {"x", "y", "z"}), normal = columns(*vertices, {"nx", "ny", "nz"});
  if (!all_scalars(*vertices, position)) fail_file(file, "element 'vertex' needs the numbers x, y and z");
  PlyContent content;
  PlyValues values(file, bytes, header);
  std::vector<double> scalar, list;
  for (PlyElement const& element : header.element) {
    bool const is_face = element.name == "face";
    int const wanted = is_face ? std::max(element.find("vertex_indices"), element.find("vertex_index")) : -1;
    if (is_face && element.count > 0 &&
        (wanted < 0 || !element.property[wanted].is_list || element.property[wanted].type >= PlyType::float32))
      fail_file(file, "element 'face' needs a list of integers vertex_indices");
    scalar.assign(element.property.size(), 0);
    for (int row = 0; row < element.count; ++row) {
      values.begin_row(element, row);
      read_row(values, element, wanted, scalar, list);
      values.end_row();
      if (&element == vertices) {
        content.vertex.push_back(pick(scalar, position));
        if (all_scalars(element, normal)) content.normal.push_back(pick(scalar, normal));
        if (!is_finite(content.vertex.back())) values.fail("a coordinate is not finite");
        if (!content.normal.empty() && !is_finite(content.normal.back())) values.fail("the normal is not finite");
      } else if (is_face) {
        add_face(values, list, static_cast<std::size_t>(vertices->count), content);
      }
    }
  }
  values.end();
  return content;
}

std::string ply_bytes(std::vector<Vec3> const& vertex, std::vector<Vec3> const& normal,
                      std::vector<std::array<int, 3>> const& triangle) {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment scree\nelement vertex " +
                    std::to_string(vertex.size()) + "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!normal.empty()) out += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!triangle.empty())
    out += "element face " + std::to_string(triangle.size()) + "\nproperty list uchar int vertex_indices\n";
  out += "end_header\n";
  auto const append = [&](auto const& value) { out.append(reinterpret_cast<char const*>(&value), sizeof(value)); };
  static_assert(sizeof(Vec3) == 24 && sizeof(Vec3f) == 12);
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    append(vertex[i]);
    if (!normal.empty()) append(to_float(normal[i]));
  }
  for (auto const& t : triangle) {
    append(std::uint8_t{3});
    for (int v : t) append(std::int32_t{v});
  }
  return out;
}

}  // namespace scree
