// Two daemons that are partners, while the tools of an arm change.
//
// Oracle: each partner compares its reports with those of the other one, bit by bit.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "monitor/client/commands.hpp"
#include "tests/shared/tool_cell.hpp"
#include "tests/tools/running_partners.hpp"
#include "tests/tools/tools_in_motion.hpp"

namespace clearance {
namespace {

using client::PartnerState;

// The cell of two boxes that meet, with the arm and its tools beside them.
std::string cell_with_tools(const test::ScratchFolder& folder) {
  test::write_tools(folder);
  std::string text = test::cell_at_rate(), tools = test::kToolCell;
  const auto section = [&tools](const char* begin, const char* end) {
    const std::size_t at = tools.find(begin) + std::string(begin).size();
    return tools.substr(at, tools.find(end, at) - at);
  };
  std::string robots = "robots:\n" + section("robots:\n", "pairs:\n");
  for (const char* file : {"urdf: ", "srdf: ", "{arm: "}) {
    const std::string key = file;
    for (std::size_t at = 0; (at = robots.find(key, at)) != std::string::npos;)
      robots.insert(at += key.size(), (folder / "").string());
  }
  std::string pairs = section("pairs:\n", "zones:\n");
  for (std::size_t at = 0; (at = pairs.find("person", at)) != std::string::npos; ++at)
    pairs.replace(at, 6, "floor");
  text.insert(text.find("zones:\n"), pairs);
  for (std::size_t at = 0; (at = text.find("[arm, still]", at)) != std::string::npos; ++at)
    text.replace(at, 12, "[boxes, still]");
  for (std::size_t at = 0; (at = text.find("groups: [arm]", at)) != std::string::npos; ++at)
    text.replace(at, 13, "groups: [boxes]");
  const std::string zone = "between: [arm, arm], enter_below";
  text.replace(text.find(zone), zone.size(), "between: [boxes, boxes], enter_below");
  return text.insert(text.find("pairs:\n"), robots);
}

class ToolPartners : private test::ScratchFolder, public test::Partners {
 protected:
  ToolPartners() : Partners(cell_with_tools(*this)) { count_apart = true; }
};

TEST_F(ToolPartners, HaveTheSameBitsWhileToolsChange) {
  const test::ToolsInMotion motion(connection);
  for (const char* name : {"left", "right"}) {
    start(name, {"--commands", "planner"});
    ASSERT_TRUE(read_until([this] { return came > 20; })) << logs();
  }
  ASSERT_TRUE(agree()) << logs();
  std::atomic<int> done{0};
  constexpr int kChanges = 12;
  std::thread sending([&] {
    client::Connection own(dds, cell.topics);
    client::Commands commands(own, "planner");
    for (int i = 0; i < kChanges; ++i) {
      const auto result = commands.send(test::next_tool(i), {}, std::chrono::seconds(20));
      EXPECT_TRUE(result && result->done()) << (result ? result->reason : "no result");
      ++done;
    }
  });
  EXPECT_TRUE(read_until([&] { return done == kChanges; }, 120)) << logs();
  sending.join();
  EXPECT_FALSE(HasFailure()) << logs();
  EXPECT_TRUE(agree()) << logs();
  EXPECT_EQ(states[PartnerState::kDifferent] + states[PartnerState::kCorrupt], 0) << logs();
}

}  // namespace
}  // namespace clearance
