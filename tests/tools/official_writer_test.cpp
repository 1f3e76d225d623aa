// Bags from the official writer of MCAP and the public packages for ROS 2's messages. The project's
// reader must read them, and the tests' own writers must produce the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "monitor/recording/bag.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/base64.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

constexpr std::int64_t kT = 1'700'000'000'000'000'000;

json time_of(std::int64_t ns) {
  return {{"sec", ns / 1'000'000'000}, {"nsec", ns % 1'000'000'000}};
}

// The content of the bag, once as the packages take it and once as the tests write it.
struct Both {
  json spec = {{"compression", ""}, {"messages", json::array()}};
  std::vector<RosMessage> ours;

  void add(const RosMessage& message, const json& value) {
    ours.push_back(message);
    spec["messages"].push_back({{"topic", message.topic},
                                {"type", message.type},
                                {"log_ns", std::to_string(message.log_ns)},
                                {"value", value}});
  }
};

Both motion() {
  Both both;
  both.add(ros_text(kT, kScaraUrdf), {{"data", kScaraUrdf}});
  for (int i = 0; i < 400; ++i) {
    const std::int64_t t = kT + i * 5'000'000;
    const double angle = 0.003 * i;
    const std::vector<std::string> names = {"elbow", "shoulder", "push"};
    both.add(joint_state(t, t - 70'000, {names, {angle, -0.1, 0.05}, {0.6, 0.0, 0.0}, {1.5}}),
             {{"header", {{"stamp", time_of(t - 70'000)}, {"frame_id", ""}}},
              {"name", names},
              {"position", {angle, -0.1, 0.05}},
              {"velocity", {0.6, 0.0, 0.0}},
              {"effort", {1.5}}});
    const json transform = {{"header", {{"stamp", time_of(t)}, {"frame_id", "world"}}},
                            {"child_frame_id", "cart"},
                            {"transform",
                             {{"translation", {{"x", -3.0}, {"y", 0.25}, {"z", angle}}},
                              {"rotation", {{"x", 0.0}, {"y", 0.6}, {"z", 0.0}, {"w", 0.8}}}}}};
    both.add(transforms(t + 1, t, {{"world", "cart", {-3.0, 0.25, angle}, {0.0, 0.6, 0.0, 0.8}}}),
             {{"transforms", json::array({transform})}});
  }
  return both;
}

class OfficialWriter : public testing::Test {
 protected:
  // Returns the output of node.
  std::string write(const json& spec, const std::string& out) {
    write_text(folder / "spec.json", spec.dump());
    const std::string command = "node " + test::places::mcap_js() + "/write_bag.mjs " + out +
                                " < " + (folder / "spec.json").string();
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string output;
    for (int c = std::getc(pipe); c != EOF; c = std::getc(pipe)) output += static_cast<char>(c);
    EXPECT_EQ(0, pclose(pipe)) << output;
    return output;
  }

  ScratchFolder folder;
  Both both = motion();
};

TEST_F(OfficialWriter, MakesTheMessagesThatOurTestsMake) {
  std::string expected;
  for (const RosMessage& message : both.ours) expected += base64(message.cdr) + '\n';
  EXPECT_EQ(expected, write(both.spec, ""));
}

TEST_F(OfficialWriter, ItsBagsAreReadHoweverTheyAreCompressed) {
  for (const char* compression : {"", "zstd", "lz4"}) {
    both.spec["compression"] = compression;
    write(both.spec, (folder / "bag.mcap").string());
    const std::unique_ptr<Bag> bag = open_bag(folder / "bag.mcap");
    BagMessage message;
    std::size_t count = 0;
    for (; bag->next(message) && count < both.ours.size(); ++count) {
      const RosMessage& expected = both.ours[count];
      EXPECT_EQ(expected.topic, message.topic->name);
      EXPECT_EQ(expected.type, message.topic->type);
      EXPECT_EQ(expected.log_ns, message.log_ns);
      EXPECT_TRUE(std::ranges::equal(expected.cdr, message.payload)) << compression << count;
    }
    EXPECT_EQ("", bag->error()) << compression;
    EXPECT_EQ(both.ours.size(), count);
  }
}

// The complete chain, compared with a bag that SQLite's library wrote.
TEST_F(OfficialWriter, ItsBagsMoveTheRobotOfACell) {
  const Cell cell{scara_cell()};
  both.spec["compression"] = "zstd";
  write(both.spec, (folder / "bag.mcap").string());
  write_sqlite_bag(folder / "bag.db3", both.ours);
  std::vector<double> lower[2];
  for (const int i : {0, 1}) {
    const OfflineReplay replay = replay_offline(
        cell, folder / (i == 0 ? "bag.mcap" : "bag.db3"), {},
        [&](const ReplayedTick& tick) { lower[i].push_back(tick.report.lower_all); });
    EXPECT_TRUE(replay.ok()) << replay.text();
    EXPECT_EQ(0u, replay.notes.size()) << replay.text();
  }
  EXPECT_EQ(1997u, lower[0].size());
  EXPECT_EQ(lower[0], lower[1]);
  EXPECT_GT(lower[0].back(), 0.0);
}

}  // namespace
}  // namespace clearance::test
