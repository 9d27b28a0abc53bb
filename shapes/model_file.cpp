// model_file.cpp: a model file as a whole: user block, checks, put in place in one step. Layout: model_content.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/model_file.h"

#include <unistd.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/file_container.h"
#include "shapes/hdf5_handle.h"
#include "shapes/model_content.h"

namespace scree {
namespace {

std::string listing(std::vector<std::string> const& found) {
  std::string text;
  for (std::string const& f : found) text += "\n  " + f;
  return text;
}

Library checked(std::string const& name, std::function<hdf5::Handle()> const& open) {
  hdf5::QuietErrors const quiet;
  Library library;
  try {
    library = read_model_content(open());
  } catch (std::exception const& e) {
    throw std::runtime_error(name + ": " + e.what());
  }
  std::vector<std::string> const found = problems(library);
  if (!found.empty()) throw std::runtime_error(name + ": not a valid model:" + listing(found));
  return library;
}

}  // namespace

void write_model(std::filesystem::path const& file, Library const& library, bool overwrite) {
  std::vector<std::string> const found = problems(library);
  if (!found.empty())
    throw std::runtime_error(file.string() + ": not written, the library is not valid:" + listing(found));
  if (!overwrite && std::filesystem::exists(file))
    throw std::runtime_error(file.string() + ": exists already and is left as it is");
  hdf5::QuietErrors const quiet;
  std::filesystem::path const temporary = file.string() + ".partial-" + std::to_string(::getpid());
  try {
    hdf5::Handle content = hdf5::create_file(temporary.string());
    write_model_content(content, library);
    content.close("cannot be written");
    seal_container(temporary, file, model_format, static_cast<std::uint32_t>(model_version(library)));
  } catch (std::runtime_error const&) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    hdf5::rethrow_as_write_error(file.string());
  }
}

Library read_model(std::filesystem::path const& file) {
  check_container(file, model_format, newest_model_version);
  return checked(file.string(), [&] { return hdf5::open_file(file.string()); });
}

Library read_model(std::string const& name, std::span<std::uint8_t const> bytes) {
  check_container(name, bytes, model_format, newest_model_version);
  return checked(name, [&] { return hdf5::open_image(bytes.data(), bytes.size()); });
}

}  // namespace scree
