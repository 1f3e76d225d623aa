// The man page and the completion of every program have what its --help has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/shared/places.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::ContainerEq;
using testing::IsEmpty;
using testing::Not;
using Words = std::set<std::string>;

std::string output_of(const std::string& program, const std::vector<std::string>& arguments) {
  ChildProcess child(program, arguments);
  EXPECT_EQ(child.wait(), 0) << program << '\n' << child.output();
  return child.output();
}

// The names of options at the beginnings of lines: "  -h,--help".
Words options_in(const std::string& help) {
  Words found;
  const std::regex line("(?:^|\n)  (-[^ \n]*)"), name("[^,]+");
  for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
    const std::string names = (*at)[1];
    for (std::sregex_iterator one(names.begin(), names.end(), name); one != end; ++one)
      found.insert(one->str());
  }
  return found;
}

Words subcommands_in(const std::string& help) {
  Words found;
  const std::size_t begin = help.find("\nSubcommands");
  if (begin == std::string::npos) return found;
  std::istringstream lines(help.substr(begin + 1));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.empty()) {
    if (line.starts_with("  ") && line[2] != ' ')
      found.insert(line.substr(2, line.find(' ', 2) - 2));
  }
  return found;
}

Words words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

class Manual : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(manuals + GetParam() + ".1"))
      GTEST_SKIP() << GetParam() << " is not built";
  }
  [[nodiscard]] std::string program() const { return places::programs() + "/" + GetParam(); }
  // The man page as a reader sees it, without hyphenation.
  [[nodiscard]] std::string page() const {
    return output_of("/usr/bin/env", {"LC_ALL=C.UTF-8", "MANWIDTH=400", "GROFF_NO_SGR=1", "man",
                                      "--nh", "-P", "/bin/cat", "-l", manuals + GetParam() + ".1"});
  }
  // The words that the shell offers after these.
  [[nodiscard]] Words offered(const std::string& before, const std::string& begun) const {
    std::string function = "_" + GetParam();
    std::replace(function.begin(), function.end(), '-', '_');
    const std::string words = GetParam() + " " + before;
    return words_of(output_of(
        "/bin/bash", {"-c", ". " + manuals + GetParam() + "; COMP_WORDS=(" + words + " '" + begun +
                                "'); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); " + function +
                                "; printf '%s\\n' \"${COMPREPLY[@]}\""}));
  }
  std::string manuals = places::programs() + "/../manuals/";
};

// Fails if a line of the page has another spelling: a dash is a dash there, not a hyphen.
void expect_in_page(const std::string& page, const Words& options) {
  std::string text = page;
  // groff prints a bold letter as three characters.
  text = std::regex_replace(text, std::regex(".\b"), "");
  Words found;
  const std::regex name("(^|[ ,\n])(--?[A-Za-z0-9_-]+)");
  for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
    found.insert((*at)[2]);
  for (const std::string& option : options) EXPECT_EQ(found.count(option), 1u) << option;
}

TEST_P(Manual, HasEveryOptionOfTheProgram) {
  const std::string help = output_of(program(), {"--help"});
  const Words options = options_in(help);
  ASSERT_THAT(options, testing::IsSupersetOf({"-h", "--help", "--version"}));
  const std::string text = page();
  expect_in_page(text, options);
  EXPECT_THAT(offered("", "-"), ContainerEq(options));
  EXPECT_THAT(offered("", "--vers"), ContainerEq(Words{"--version"}));
  const Words subcommands = subcommands_in(help);
  if (!subcommands.empty()) {
    EXPECT_THAT(offered("", ""), ContainerEq(subcommands));
  }
  for (const std::string& subcommand : subcommands) {
    const Words its = options_in(output_of(program(), {subcommand, "--help"}));
    ASSERT_THAT(its, Not(IsEmpty())) << subcommand;
    expect_in_page(text, its);
    EXPECT_THAT(offered(subcommand, "-"), ContainerEq(its)) << subcommand;
  }
}

TEST_P(Manual, VersionNamesTheVersionAndTheCommit) {
  const std::string version = output_of(program(), {"--version"});
  EXPECT_TRUE(std::regex_search(version, std::regex("^clearance [0-9]+\\.[0-9]+\\.[0-9]+, ")))
      << version;
  EXPECT_NE(page().find(version.substr(10, version.find(',') - 10)), std::string::npos);
}

TEST(ManualOfTheDaemon, CompletionOffersTheValuesOfAnOptionThatHasOnlySome) {
  const std::string file = places::programs() + "/../manuals/clearanced";
  const Words levels = words_of(
      output_of("/bin/bash", {"-c", ". " + file +
                                        "; COMP_WORDS=(clearanced --log-level ''); COMP_CWORD=2; "
                                        "_clearanced; echo \"${COMPREPLY[@]}\""}));
  EXPECT_THAT(levels, ContainerEq(Words{"trace", "debug", "info", "warn", "error", "off"}));
}

INSTANTIATE_TEST_SUITE_P(Every, Manual,
                         testing::Values("clearanced", "clearance-ask", "clearance-distance",
                                         "clearance-plc", "clearance-record", "clearance-replay",
                                         "clearance-robot", "clearance-scene", "clearance-view",
                                         "clearance-watch"),
                         [](const auto& program) {
                           std::string name = program.param;
                           std::erase(name, '-');
                           return name;
                         });

// tools/demo reads its options, and stops at the cell that is not there, before it builds anything.
TEST(Demo, TakesEachOfItsOptionsAndOneOfThemOnly) {
  const std::string demo = places::sources() + "/tools/demo";
  for (const char* option : {"--avoid", "--pick", "--ask", "--camera", "--plc"}) {
    ChildProcess child("/usr/bin/env", {"bash", demo, option, "/nowhere.yaml"});
    EXPECT_EQ(child.wait(), 2);
    EXPECT_TRUE(child.wrote("cannot read /nowhere.yaml")) << option << '\n' << child.output();
  }
  ChildProcess both("/usr/bin/env", {"bash", demo, "--camera", "--ask"});
  EXPECT_EQ(both.wait(), 2);
  EXPECT_TRUE(both.wrote("one of --avoid")) << both.output();
}

}  // namespace
}  // namespace clearance::test
