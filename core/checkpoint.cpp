// checkpoint.cpp: the file of a checkpoint as a whole: its user block, its checks, put in place in one step.
// Taking one of a Simulation, and going on from it: core/restart.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint.h"

#include <stdexcept>
#include <system_error>

#include "core/case.h"
#include "core/checkpoint_content.h"
#include "shapes/file_container.h"

namespace scree {

namespace fs = std::filesystem;

void write_checkpoint(fs::path const& file, Checkpoint const& checkpoint) {
  hdf5::QuietErrors const quiet;
  fs::path const temporary = file.string() + ".partial";
  try {
    fs::remove(temporary);
    hdf5::Handle content = hdf5::create_file(temporary.string());
    write_checkpoint_content(content, checkpoint);
    content.close("cannot be written");
    seal_container(temporary, file, checkpoint_format, checkpoint_version);
  } catch (std::runtime_error const&) {
    std::error_code ignored;
    fs::remove(temporary, ignored);  // on a full disk its place is needed
    hdf5::rethrow_as_write_error(file.string());
  }
}

Checkpoint read_checkpoint(fs::path const& file) {
  hdf5::QuietErrors const quiet;
  try {
    check_container(file, checkpoint_format, checkpoint_version);
    return read_checkpoint_content(hdf5::open_file(file.string()));
  } catch (std::exception const& e) {
    std::string const what = e.what();
    throw InputError({what.starts_with(file.string()) ? what : file.string() + ": " + what});
  }
}

}  // namespace scree
