#include "monitor/wire/topics.hpp"
#include "tests/shared/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

namespace clearance {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" `");
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(" `") - begin + 1);
}

// The rows of the table of topics in idl/README.md, cell by cell.
std::vector<std::vector<std::string>> documented() {
  std::ifstream page(test::places::sources() + "/idl/README.md");
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| `clearance/")) continue;
    std::vector<std::string>& row = rows.emplace_back();
    std::istringstream cells(line.substr(1));
    for (std::string cell; std::getline(cells, cell, '|');) row.push_back(trimmed(cell));
  }
  return rows;
}

std::string key_of(const dds_topic_descriptor_t& type) {
  std::string keys;
  for (std::uint32_t i = 0; i < type.m_nkeys; ++i)
    keys += (keys.empty() ? "" : "`, `") + std::string(type.m_keys[i].m_name);
  return keys.empty() ? "none" : keys;
}

std::vector<std::string> row_of(const Topic& topic) {
  const bool latched = topic.delivery == Delivery::kLatched;
  const std::string type = topic.type->m_typename;
  return {Topics{}.*topic.name,
          type.substr(type.rfind(':') + 1),
          key_of(*topic.type),
          "",  // the program decides when it is written
          "reliable",
          latched ? "transient-local" : "volatile",
          "keep-last " + std::to_string(topic.writer_depth)};
}

TEST(Topics, StandInTheTableInTheOrderOfTheirKind) {
  for (std::size_t i = 0; i < kTopics.size(); ++i) EXPECT_EQ(index(kTopics[i].kind), i);
}

TEST(Topics, AreWhatTheReadmeOfTheIdlSays) {
  const auto rows = documented();
  ASSERT_EQ(rows.size(), kTopics.size());
  for (const Topic& topic : kTopics) {
    const std::vector<std::string> expected = row_of(topic);
    const auto row = std::ranges::find(rows, expected[0], [](const auto& r) { return r[0]; });
    ASSERT_NE(row, rows.end()) << expected[0];
    ASSERT_EQ(row->size(), expected.size()) << expected[0];
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (!expected[i].empty()) {
        EXPECT_EQ((*row)[i], expected[i]) << expected[0];
      }
    }
  }
}

// A state replaces the one before it. Results of commands do not: a client that reads late gets
// those that it has not read.
TEST(Topics, LatchedStatesKeepOneSampleOfAKey) {
  for (const Topic& topic : kRecordedTopics) {
    if (topic.delivery != Delivery::kLatched) continue;
    EXPECT_EQ(topic.writer_depth, 1);
    EXPECT_EQ(topic.reader_depth, 1);
  }
}

}  // namespace
}  // namespace clearance
