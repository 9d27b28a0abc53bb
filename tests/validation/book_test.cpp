// book_test.cpp: the book itself: each bound passes and fails where it must, and wrong physics is seen.
// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/book.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

namespace scree::book {
namespace {

TEST(Book, BoundsPassAndFailWhereTheyMust) {
  Entry e("validation", "book", "bounds", "definition");
  e.expect_to_fail();
  EXPECT_TRUE(e.relative("a", "", -2, -2.02, 0.011));
  EXPECT_FALSE(e.relative("a", "", -2, -2.03, 0.011));
  EXPECT_TRUE(e.absolute("a", "", 0, 0.1, 0.1));
  EXPECT_FALSE(e.absolute("a", "", 0, -0.11, 0.1));
  EXPECT_TRUE(e.at_most("a", "", 1, 1));
  EXPECT_FALSE(e.at_most("a", "", 1.1, 1));
  EXPECT_TRUE(e.at_least("a", "", 1, 1));
  EXPECT_FALSE(e.at_least("a", "", 0.9, 1));
  EXPECT_FALSE(e.at_most("a", "", std::nan(""), 1));
  EXPECT_FALSE(e.relative("a", "", 1, INFINITY, 1e9));
  EXPECT_FALSE(e.passed());
}

void entry_that_fails() { Entry("hard", "x", "t", "s").at_most("energy", "J", 2, 1); }
void entry_without_rows() { Entry("hard", "x", "t", "s"); }

// Without the files of the book, where these rows do not belong.
class WithoutFiles {
 public:
  WithoutFiles() {
    for (char const* variable : variables)
      if (char const* file = std::getenv(variable)) saved_[variable] = file, ::unsetenv(variable);
  }
  ~WithoutFiles() {
    for (auto const& [variable, file] : saved_) ::setenv(variable.c_str(), file.c_str(), 1);
  }

 private:
  static constexpr char const* variables[] = {"SCREE_BOOK_CSV", "SCREE_BOOK_CURVES"};
  std::map<std::string, std::string> saved_;
};

TEST(Book, RowsThatDoNotPassFailTheTest) {
  WithoutFiles const none;
  EXPECT_NONFATAL_FAILURE(entry_that_fails(), "energy is 2 J");
  EXPECT_NONFATAL_FAILURE(entry_without_rows(), "measured nothing");
}

}  // namespace
}  // namespace scree::book
