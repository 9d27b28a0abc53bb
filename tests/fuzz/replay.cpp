// replay.cpp: runs a fuzz target over the files of folders, without a fuzzer: what was found once stays found.
// Usage: replay_NAME FOLDER...
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size);

int main(int count, char** argument) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i)
    for (auto const& entry : std::filesystem::directory_iterator(argument[i])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (std::filesystem::path const& file : files) {
    std::ifstream stream(file, std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(stream), {}};
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);  // the last line names the input that crashed
    LLVMFuzzerTestOneInput(reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size());
  }
  std::printf("%zu inputs\n", files.size());
  return files.empty() ? 1 : 0;
}
