// test_file_container.cpp: a damaged, truncated or mistaken file never reaches HDF5.
// The payload here is arbitrary bytes: the container does not look inside.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <system_error>

#include "shapes/file_container.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::string read_bytes(fs::path const& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write_bytes(fs::path const& file, std::string const& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

class FileContainer : public testing::Test {
 protected:
  FileContainer() {
    folder = fs::temp_directory_path() / ("scree_container_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    file = folder / "a.h5";
    std::string bytes(container_block_size, '\0');
    for (int i = 0; i < 3000; ++i) bytes += static_cast<char>(i * 7);
    write_bytes(folder / "a.tmp", bytes);
    seal_container(folder / "a.tmp", file, "scree.model", 1);
  }
  ~FileContainer() override { fs::remove_all(folder); }

  // The message of check_container, "" when the file passes.
  std::string complaint(fs::path const& name, std::string const& kind = "scree.model", std::uint32_t version = 1) {
    try {
      check_container(name, kind, version);
    } catch (std::exception const& e) {
      return e.what();
    }
    return "";
  }
  fs::path folder, file;
};

TEST_F(FileContainer, SealedFilePassesAndTemporaryIsGone) {
  EXPECT_EQ(complaint(file), "");
  EXPECT_FALSE(fs::exists(folder / "a.tmp"));
  EXPECT_EQ(fs::file_size(file), container_block_size + 3000u);
}

TEST_F(FileContainer, EveryFlippedBitIsFound) {
  std::string const good = read_bytes(file);
  for (std::size_t byte = 0; byte < good.size(); byte += byte < container_block_size ? 1 : 101) {
    std::string bad = good;
    bad[byte] = static_cast<char>(bad[byte] ^ (1 << (byte % 8)));
    write_bytes(file, bad);
    EXPECT_NE(complaint(file), "") << "byte " << byte;
  }
}

TEST_F(FileContainer, TruncationIsFoundAtEveryLength) {
  std::string const good = read_bytes(file);
  for (std::size_t length : {1u, 10u, 55u, 56u, 511u, 512u, 513u, 2000u, 3511u}) {
    write_bytes(file, good.substr(0, length));
    EXPECT_NE(complaint(file), "") << "length " << length;
  }
  write_bytes(file, good.substr(0, 2000));
  EXPECT_NE(complaint(file).find("cut short"), std::string::npos) << complaint(file);
  write_bytes(file, good + "x");
  EXPECT_NE(complaint(file).find("damaged"), std::string::npos) << complaint(file);
}

TEST_F(FileContainer, MixUpsAreNamed) {
  EXPECT_NE(complaint(file, "scree.results").find("\"scree.model\""), std::string::npos);
  EXPECT_NE(complaint(file, "scree.model", 0).find("newer Scree"), std::string::npos);
  EXPECT_NE(complaint(folder / "none.h5").find("no such file"), std::string::npos);
  EXPECT_NE(complaint(folder).find("folder"), std::string::npos);
  write_bytes(folder / "empty.h5", "");
  EXPECT_NE(complaint(folder / "empty.h5").find("empty"), std::string::npos);
  write_bytes(folder / "text.h5", "not a Scree file at all, but long enough for a header to be looked for in it");
  EXPECT_NE(complaint(folder / "text.h5").find("not a Scree file"), std::string::npos);
  EXPECT_EQ(complaint(folder / "none.h5").rfind((folder / "none.h5").string(), 0), 0u);  // the file comes first
}

TEST_F(FileContainer, FailedRenameNamesTheFile) {
  write_bytes(folder / "b.tmp", std::string(container_block_size + 1, 'x'));
  try {
    seal_container(folder / "b.tmp", folder / "missing" / "b.h5", "scree.model", 1);
    FAIL() << "no exception";
  } catch (std::system_error const& e) {
    EXPECT_NE(std::string(e.what()).find("b.h5"), std::string::npos) << e.what();
  }
  EXPECT_THROW(seal_container(folder / "none.tmp", file, "scree.model", 1), std::system_error);
  write_bytes(folder / "short.tmp", "x");
  EXPECT_THROW(seal_container(folder / "short.tmp", file, "scree.model", 1), std::system_error);
}

}  // namespace
}  // namespace scree
