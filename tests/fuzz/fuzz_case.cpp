// fuzz_case.cpp: the text of a case file. A case that is accepted is written out and read back the same.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_text.h"
#include "tests/fuzz/fuzz_input.h"

using namespace scree;

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  Case c;
  try {
    c = case_from_text({reinterpret_cast<char const*>(data), size}, "/nowhere/fuzz.toml");
  } catch (InputError const& error) {
    fuzz::must(!error.problems.empty(), "a refused case has a reason");
    return 0;
  }
  std::string const echo = to_toml(c);
  try {
    fuzz::must(to_toml(case_from_text(echo, "/nowhere/fuzz.toml")) == echo, "the effective case reads back the same");
  } catch (InputError const& error) {
    std::fprintf(stderr, "%s\n%s\n", echo.c_str(), error.what());
    fuzz::must(false, "the effective case is a case");
  }
  return 0;
}
