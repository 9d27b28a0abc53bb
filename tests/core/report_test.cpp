// report_test.cpp: `scree report`: its building blocks, what the page holds, and a browser that opens it without error.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "shapes/analytic_shapes.h"
#include "tests/support/shell.h"
#include "tools/report_page.h"
#include "tools/report_scene.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

TEST(ReportText, Base64IsThatOfRfc4648) {
  // Section 10 of the RFC.
  for (auto const& [text, code] : {std::pair<std::string, std::string>("", ""),
                                   {"f", "Zg=="},
                                   {"fo", "Zm8="},
                                   {"foo", "Zm9v"},
                                   {"foob", "Zm9vYg=="},
                                   {"fooba", "Zm9vYmE="},
                                   {"foobar", "Zm9vYmFy"}})
    EXPECT_EQ(base64(text.data(), text.size()), code);
}

TEST(ReportText, StringsCannotLeaveTheirScript) {
  EXPECT_EQ(json_string("a\"b\\c\n</script>\x01"), "\"a\\\"b\\\\c\\n\\u003c/script>\\u0001\"");
}

TEST(ReportText, ThinningKeepsFirstAndLast) {
  EXPECT_EQ(thinned(0, 5), (std::vector<std::size_t>{}));
  EXPECT_EQ(thinned(1, 5), (std::vector<std::size_t>{0}));
  EXPECT_EQ(thinned(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  auto const some = thinned(1001, 11);
  ASSERT_EQ(some.size(), 11u);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i], 100 * i);
}

// Two of three spheres are 0.02 d in each other: the last number of their rows is that, the third's is 0.
TEST(ReportScene, RowsEndWithTheDeepestOverlap) {
  ResultsHeader header;
  header.library.shape = {make_sphere()};
  header.shape_name = {"sphere"};
  header.domain = {{0, 0, 0}, {3, 1, 1}};
  Frame frame;
  for (double x : {0.0, 0.98, 3.0}) {
    header.shape.push_back(0);
    header.diameter.push_back(1);
    header.group.push_back(7);
    frame.position.push_back({x, 0, 0});
    frame.orientation.push_back({});
    frame.velocity.push_back({});
  }
  std::string const json = scene_json(header, frame, 1);
  std::vector<double> overlap;
  for (std::size_t at = json.find(",7,"); at != std::string::npos; at = json.find(",7,", at + 1))
    overlap.push_back(std::stod(json.substr(at + 3)));
  ASSERT_EQ(overlap.size(), 3u) << json.substr(0, 500);
  // Points stand at most 0.05 apart, so the meter misses s^2 / (4 R) = 0.0013 at most.
  for (int i : {0, 1}) EXPECT_NEAR(overlap[i], 0.02, 0.0013);
  EXPECT_EQ(overlap[2], 0);
  EXPECT_EQ(json, scene_json(header, frame, 2));
}

char const* const case_text = R"([case]
name = "two </script> <kinds>"
[time]
end = 0.002
step = 1e-5
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6 }
[[grains]]
name = "one"
material = "rock"
shapes = ["sphere", "box:1:0.8:0.6"]
nodes = 250
count = 4
diameter = 0.1
insert = { kind = "lattice", box = [[0, 0, 0], [0.4, 0.4, 0.4]], velocity = [0, 0, -1] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
[[wall]]
name = "drum"
kind = "cylinder"
from = [0.2, 0.2, -1]
to = [0.2, 0.2, 1]
radius = 0.6
material = "rock"
[[measure]]
name = "contacts"
kind = "coordination"
every = 0.0002
[output]
every = 0.001
)";

Outcome shell(std::string const& command) { return testing::shell("/", command); }

class Report : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = fs::temp_directory_path() / ("scree_report_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "two.toml") << case_text;
    Outcome const run = shell(SCREE_PROGRAM " run " + (folder / "two.toml").string() +
                              " --threads 1 --quiet --output " + (folder / "out").string());
    ASSERT_EQ(run.code, 0) << run.text;
    Outcome const report = shell(SCREE_PROGRAM " report " + (folder / "out").string());
    ASSERT_EQ(report.code, 0) << report.text;
    std::ostringstream text;
    text << std::ifstream(folder / "out/report.html").rdbuf();
    html = text.str();
  }
  static void TearDownTestSuite() { fs::remove_all(folder); }
  static fs::path folder;
  static std::string html;
};
fs::path Report::folder;
std::string Report::html;

TEST_F(Report, HoldsEverythingAndAsksNobody) {
  EXPECT_LT(html.size(), 5'000'000u);
  for (char const* word : {"@DATA@", "@RUN@", "@PICTURE@", "@TITLE@", "fetch(", "XMLHttpRequest", "<link", "import(",
                           "src=\"http", "href=\"http", "url(http"})
    EXPECT_EQ(html.find(word), std::string::npos) << word;
  for (char const* word : {"contacts.grains", "lost to contact damping", "integrate", "data:image/png;base64,iVBOR",
                           "particle_steps_per_second", "\"solid\":true", "\"solid\":false"})
    EXPECT_NE(html.find(word), std::string::npos) << word;
  EXPECT_NE(html.find("<title>two &lt;/script> &lt;kinds></title>"), std::string::npos);
}

TEST_F(Report, NamesWhatIsNotThere) {
  Outcome const none = shell(SCREE_PROGRAM " report " + (folder / "nowhere").string());
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.text.find("nowhere"), std::string::npos) << none.text;
  Outcome const blocked =
      shell(SCREE_PROGRAM " report " + (folder / "out").string() + " -o " + (folder / "absent/page.html").string());
  EXPECT_EQ(blocked.code, 4);
  EXPECT_NE(blocked.text.find("page.html"), std::string::npos) << blocked.text;
}

// A browser runs the page to its end and finds nothing to complain of.
TEST_F(Report, OpensInABrowserWithoutAnError) {
  if (shell("command -v chromium").code != 0) GTEST_SKIP() << "no chromium on the PATH";
  std::string const browser =
      "timeout 120 chromium --headless=new --no-sandbox --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --enable-logging=stderr --virtual-time-budget=8000 "
      "--user-data-dir=" +
      (folder / "profile").string() + " --dump-dom file://";
  std::ofstream(folder / "chosen.html")
      << html << "<script>const menu = document.getElementById('colour'); menu.value = 'overlap';"
      << "menu.dispatchEvent(new Event('change'));</script>";
  Outcome const page = shell(browser + (folder / "chosen.html").string());
  EXPECT_NE(page.text.find("data-ready=\"yes\""), std::string::npos) << page.text.substr(0, 2000);
  EXPECT_EQ(page.text.find("CONSOLE"), std::string::npos) << page.text.substr(0, 2000);
  EXPECT_NE(page.text.find("<path d=\"M"), std::string::npos) << "no curve was drawn";
  EXPECT_NE(page.text.find("<span id=\"view_scale\">each grain's deepest, up to "), std::string::npos) << "no scale";

  // The check itself: a page with an error is noticed.
  std::ofstream(folder / "broken.html") << "<script>undefined_name();</script>";
  Outcome const broken = shell(browser + (folder / "broken.html").string());
  EXPECT_NE(broken.text.find("CONSOLE"), std::string::npos) << broken.text.substr(0, 2000);
}

}  // namespace
}  // namespace scree
