// The wording of every log line of the daemon is kept in tests/monitor/app/messages.golden.
#include "monitor/interface/all_log_lines.hpp"
#include "tests/shared/places.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace clearance {
namespace {

const std::string kGolden = test::places::sources() + "/tests/monitor/app/messages.golden";

std::string content(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// An example argument: "A" for a first argument that is a text, 2 for a count, 2.5 for a length or
// a rate.
template <class Argument>
Argument sample(std::size_t place) {
  static constexpr std::string_view kNames = "ABCDEFGHIJ";
  if constexpr (std::is_same_v<Argument, std::string_view>)
    return kNames.substr(place, 1);
  else
    return static_cast<Argument>(2.5 + static_cast<double>(place));
}

template <class... Arguments, std::size_t... kPlaces>
std::string with_samples(const LogLine<Arguments...>& line, std::index_sequence<kPlaces...>) {
  static constexpr std::string_view kLevels[] = {"info", "warning", "error"};
  return fmt::format("{}: {} [{}]\n", kLevels[static_cast<int>(line.level)],
                     worded(line, sample<Arguments>(kPlaces)...), line.code);
}
template <class... Arguments>
std::string with_samples(const LogLine<Arguments...>& line) {
  return with_samples(line, std::index_sequence_for<Arguments...>());
}

TEST(LogLines, AreWordedAsInTheGoldenFile) {
  std::string text;
  std::apply([&](const auto&... line) { ((text += with_samples(line)), ...); }, lines::kAll);
  if (std::getenv("CLEARANCE_WRITE_GOLDEN") != nullptr) std::ofstream(kGolden) << text;
  EXPECT_EQ(content(kGolden), text) << "CLEARANCE_WRITE_GOLDEN=1 writes the file anew";
}

TEST(LogLines, AreAllInTheList) {
  const std::string folder = test::places::sources() + "/monitor/interface/";
  std::string header;
  for (const char* const file : {"log_lines.hpp", "plc_log_lines.hpp", "merge_log_lines.hpp"})
    header += content(folder + file);
  std::size_t entries = 0;
  for (std::size_t at = 0; (at = header.find("constexpr LogLine<", at)) != std::string::npos;
       ++at) {
    ++entries;
  }
  EXPECT_EQ(entries, std::tuple_size_v<decltype(lines::kAll)>);
}

// Two lines with one code differ in their level.
TEST(LogLines, HaveCodesOfTheirOwnInSmallLetters) {
  std::set<std::pair<std::string_view, LogLevel>> codes;
  const auto add = [&](std::string_view code, LogLevel level) {
    EXPECT_TRUE(codes.emplace(code, level).second) << code;
    EXPECT_EQ(code.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), code.npos) << code;
  };
  std::apply([&](const auto&... line) { (add(line.code, line.level), ...); }, lines::kAll);
}

TEST(Counted, HasTheRightPlural) {
  EXPECT_EQ("1 batch", counted(1, "batch", "batches"));
  EXPECT_EQ("2 batches", counted(2, "batch", "batches"));
}

}  // namespace
}  // namespace clearance
