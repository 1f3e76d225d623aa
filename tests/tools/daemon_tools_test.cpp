// Tools of an arm change by commands to a running daemon, over real DDS.
//
// Oracle: a replay of the recording, which makes every report again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/tool_cell.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/tools_in_motion.hpp"

namespace clearance::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class DaemonTools : public RunsPrograms {
 protected:
  DaemonTools() {
    text.replace(text.find("objects:"), 0,
                 "rate_hz: 200\ndefaults: {age_limit_ms: 10000, max_speed: 1}\n");
    write_tools(folder, text);
  }

  std::string text = kToolCell;
};

TEST_F(DaemonTools, ThatChangeAreReplayedToTheSameBits) {
  const DdsOptions dds = own_dds();
  constexpr int kTimes = 10;
  {
    ChildProcess daemon(
        kDaemon, with({path("cell.yaml"), "--record", path("run.mcap")}, dds_arguments(dds)));
    client::Connection connection(dds);
    const ToolsInMotion motion(connection);
    client::Commands commands(connection, "planner");
    std::uint64_t before = 0;
    for (int i = 0; i < kTimes; ++i) {
      const auto result = commands.send(next_tool(i), {}, std::chrono::seconds(20));
      ASSERT_TRUE(result) << daemon.output();
      ASSERT_TRUE(result->done()) << i << ": " << result->path << ": " << result->reason;
      EXPECT_GT(result->in_force_from, before);
      before = result->in_force_from;
    }
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  }
  EXPECT_EQ(run(kReplay, {"check", path("run.mcap"), "--compare"}), 0) << output;
  EXPECT_THAT(output, HasSubstr("ticks"));
}

TEST_F(DaemonTools, ThatAreAbsentAreNotMissed) {
  const std::string stands = "joints: {finger: {position: 0.01}}";
  text.replace(text.find(stands), stands.size(), "absent: true");
  write_text(folder / "cell.yaml", text);
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({path("cell.yaml")}, dds_arguments(dds)));
  client::Connection connection(dds);
  client::Health health(connection);
  ASSERT_TRUE(eventually([&] {
    health.update();
    return health.message() != nullptr;
  })) << daemon.output();
  const auto names_of = [](const auto& entries) {
    std::vector<std::string> names;
    for (const auto& entry : std::span(entries._buffer, entries._length))
      names.emplace_back(entry.name);
    return names;
  };
  EXPECT_THAT(names_of(health.message()->inputs), Contains("person"));
  EXPECT_THAT(names_of(health.message()->inputs), Not(Contains(StartsWith("g_"))));
  EXPECT_THAT(names_of(health.message()->joints), Contains("t_tilt"));
  EXPECT_THAT(names_of(health.message()->joints), Not(Contains(StartsWith("g_"))));
}

}  // namespace
}  // namespace clearance::test
