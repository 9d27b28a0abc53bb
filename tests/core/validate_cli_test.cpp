// validate_cli_test.cpp: `scree validate` with a book of shell script: choice of entries, files, exit codes, crashes.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

namespace fs = std::filesystem;

// Lists and runs entries the way GoogleTest does; rows as tests/validation/book.cpp writes them.
char const* const script = R"(#!/bin/sh
if [ "$1" = --gtest_list_tests ]; then
  printf 'Running main()\nValidation.\n  Row10Bad\n  Row1Good\n  Row7aCrashes\nHard.\n  NeedlesLeave\n  DISABLED_Old\n'
  exit 0
fi
row() { echo "$1,\"$2\",\"title, \"\"quoted\"\"\",\"figure\",\"m\",relative,2,$3,0.01,$4,\"source\",0.1" >> "$SCREE_BOOK_CSV"; }
case "$1" in
  *Row1Good) row validation 1 2.001 1; echo 'validation,"1","y [m] against x [m]",1,2,2.001' >> "$SCREE_BOOK_CURVES"
    test -z "$SCREE_BOOK_FULL" || row validation 1 2.002 1
    echo '[       OK ] Row1Good' ;;
  *Row10Bad) row validation 10 3 0; echo '[  FAILED  ] Row10Bad'; exit 1 ;;
  *Row7aCrashes) row validation 7a 2 1; kill -SEGV $$ ;;
  *NeedlesLeave) exit 0 ;;
esac
)";

class Validate : public ::testing::Test {
 protected:
  Validate() : folder(fs::temp_directory_path() / ("scree_validate_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    std::ofstream(folder / "book.sh") << script;
    fs::permissions(folder / "book.sh", fs::perms::owner_all);
    ::setenv("SCREE_BOOK", (folder / "book.sh").c_str(), 1);
  }
  ~Validate() override {
    ::unsetenv("SCREE_BOOK");
    fs::remove_all(folder);
  }

  int run(std::string const& arguments) {
    std::string const out = (folder / "out").string(), words = (folder / "words").string();
    std::string const command =
        "'" SCREE_PROGRAM "' validate " + arguments + " -o '" + out + "' > '" + words + "' 2>&1";
    int const status = std::system(command.c_str());
    said = read(folder / "words");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static std::string read(fs::path const& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::string file(char const* name) const { return read(folder / "out" / name); }
  bool told(std::string const& what) const { return said.find(what) != std::string::npos; }

  fs::path folder;
  std::string said;
};

TEST_F(Validate, AGoodEntryPassesAndItsFilesAreWritten) {
  EXPECT_EQ(run("1"), 0) << said;
  EXPECT_TRUE(told("validation 1: title, \"quoted\"")) << said;
  EXPECT_TRUE(told("+- 1 %  pass")) << said;
  EXPECT_FALSE(told("Row10Bad")) << "1 is not 10";
  EXPECT_EQ(file("validation.csv"),
            "part,id,title,figure,unit,bound,expected,measured,tolerance,passed,source,seconds\n"
            "validation,\"1\",\"title, \"\"quoted\"\"\",\"figure\",\"m\",relative,2,2.001,0.01,1,\"source\",0.10\n");
  EXPECT_EQ(file("curves.csv"),
            "part,id,curve,x,expected,measured\nvalidation,\"1\",\"y [m] against x [m]\",1,2,2.001\n");
  EXPECT_FALSE(fs::exists(folder / "out" / "entries"));
  // The page needs Matplotlib; without it the reason is told and nothing else changes.
  EXPECT_NE(fs::exists(folder / "out" / "validation.html"), told("no page of plots: ")) << said;
}

TEST_F(Validate, FullIsPassedOn) {
  EXPECT_EQ(run("1 --full"), 0) << said;
  EXPECT_NE(file("validation.csv").find("2.002"), std::string::npos);
}

TEST_F(Validate, AFigureOutsideFailsTheProgram) {
  EXPECT_EQ(run("row10"), 1) << said;
  EXPECT_TRUE(told("+- 1 %  FAIL")) << said;
  EXPECT_TRUE(told("1 FAIL, 1 figures outside")) << said;
}

TEST_F(Validate, ACrashIsNamedAndLosesNoOtherEntry) {
  EXPECT_EQ(run(""), 1);
  EXPECT_TRUE(told("Validation.Row7aCrashes: killed by signal 11")) << said;
  EXPECT_TRUE(told("Hard.NeedlesLeave: ended with exit code 0 in the middle of its test")) << said;
  EXPECT_TRUE(told("4 entries, 5 figures: 3 FAIL, 3 figures outside")) << said;
  EXPECT_NE(file("validation.csv").find("\"Validation.Row7aCrashes\",\"comes to its end\",\"killed by signal 11"),
            std::string::npos)
      << file("validation.csv");
}

TEST_F(Validate, NamesAreNumbersPartsAndPieces) {
  EXPECT_EQ(run("hard --list"), 0);
  EXPECT_EQ(said, "Validation.Row1Good\nValidation.Row7aCrashes\nValidation.Row10Bad\nHard.NeedlesLeave\n");
  EXPECT_EQ(run("needles"), 1);
  EXPECT_TRUE(told("[1/1]")) << said;
  EXPECT_EQ(run("7"), 2) << "7 is not 7a";
  EXPECT_TRUE(told("no entry '7'") && told("Validation.Row7aCrashes")) << said;
}

TEST_F(Validate, AMissingBookIsSaidSo) {
  ::setenv("SCREE_BOOK", "/nowhere/scree-book", 1);
  EXPECT_EQ(run(""), 2);
  EXPECT_TRUE(told("$SCREE_BOOK is /nowhere/scree-book, which is not there")) << said;
}

}  // namespace
