// Shares of the same measured cost. The oracle is the table of the same run, which says of each
// pair and tick whether it was evaluated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <regex>
#include <sstream>
#include <thread>

#include "config/cell/cell_file.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

constexpr int kMeasuredTicks = 400;

// A busy cart among four posts, and an idle one that is far from all others.
constexpr const char* kHall = R"(name: hall
units: {length: m, angle: deg}
defaults: {age_limit_ms: 50, max_speed: 5, may_jump: true}
objects:
  - {name: busy, groups: [carts], sphere: {radius: 0.1}}
  - {name: idle, groups: [carts], sphere: {radius: 0.1}}
  - {name: north, groups: [posts], fixed: true, pose: {xyz: [0, 0.5, 0]}, sphere: {radius: 0.1}}
  - {name: south, groups: [posts], fixed: true, pose: {xyz: [0, -0.5, 0]}, sphere: {radius: 0.1}}
  - {name: east, groups: [posts], fixed: true, pose: {xyz: [0.5, 0, 0]}, sphere: {radius: 0.1}}
  - {name: west, groups: [posts], fixed: true, pose: {xyz: [-0.5, 0, 0]}, sphere: {radius: 0.1}}
pairs:
  - {between: [carts, posts], publish: false}
zones:
  - {name: near, between: [carts, posts], enter_below: 0.3, leave_above: 0.31}
)";

class ShareBalance : public RunsPrograms {
 protected:
  void SetUp() override {
    std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
    for (int tick = 0; tick < kMeasuredTicks; ++tick) {
      const double angle = 0.05 * tick;
      log += fmt::format("{0},busy,{1},{2},0,1,0,0,0\n{0},idle,50,0,0,1,0,0,0\n", tick * 1'000'000,
                         0.1 * std::cos(angle), 0.1 * std::sin(angle));
    }
    write_text(folder / "cell.yaml", kHall);
    write_text(folder / "log.csv", log);
    ASSERT_EQ(0, run(kRecord, {"--from-csv", path("log.csv"), "-o", path("run.mcap"), "--cell",
                               path("cell.yaml")}))
        << output;
  }
  int balance(const std::string& cell, const std::string& count,
              const std::vector<std::string>& more = {}) {
    return run(kReplay,
               with({"check", "--cell", path(cell), path("run.mcap"), "--balance", count}, more));
  }
  // The number of evaluations of each pair, by the table that --csv writes.
  [[nodiscard]] std::map<std::string, int> evaluated() const {
    std::map<std::string, int> count;
    std::istringstream rows(read_text(folder / "run.csv"));
    std::string tick, now, a, b, status, rest;
    std::getline(rows, rest);
    while (std::getline(rows, tick, ',') && std::getline(rows, now, ',') &&
           std::getline(rows, a, ',') && std::getline(rows, b, ',') &&
           std::getline(rows, status, ',') && std::getline(rows, rest)) {
      count[a + " " + b] += status == "carried" ? 0 : 1;
    }
    return count;
  }
};

TEST_F(ShareBalance, IsThatOfTheEvaluationsAndTheCellTakesItsKey) {
  ASSERT_EQ(0, balance("cell.yaml", "2", {"--csv", path("run.csv")})) << output;
  static const std::regex kKey(R"(shares: [^\n]*)"),
      kShare(
          R"re(# share (\d): (\d+) pairs, ([\d.]+) evaluations a tick, ([\d.]+) % of the cost \(([\d.]+) %)re");
  std::smatch key;
  ASSERT_TRUE(std::regex_search(output, key, kKey)) << output;
  const std::string printed = output;
  write_text(folder / "divided.yaml", kHall + key.str() + "\n");

  const CellResult read = read_cell((folder / "divided.yaml").string());
  const auto* cell = std::get_if<Cell>(&read);
  ASSERT_NE(cell, nullptr) << std::get<std::vector<CellError>>(read).front().text;
  ASSERT_EQ(cell->shares.all.size(), 2u);
  const std::map<std::string, int> counted = evaluated();
  std::size_t share = 0;
  for (std::sregex_iterator at(printed.begin(), printed.end(), kShare), end; at != end;
       ++at, ++share) {
    ASSERT_LT(share, 2u);
    double evaluations = 0.0;
    for (const std::uint32_t pair : cell->shares.all[share].pairs) {
      const ObjectPair& of = cell->scene.pairs[pair];
      evaluations += counted.at(cell->scene.objects[of.first].name + " " +
                                cell->scene.objects[of.second].name);
    }
    EXPECT_EQ(std::stoul((*at)[2]), cell->shares.all[share].pairs.size());
    EXPECT_NEAR(std::stod((*at)[3]), evaluations / kMeasuredTicks, 0.051) << share;
    EXPECT_NEAR(std::stod((*at)[4]), 50.0, 15.0) << "one of four posts is a quarter";
    EXPECT_TRUE(share == 1 || std::stod((*at)[5]) > 90.0) << "the busy cart's pairs stand first";
  }
  EXPECT_EQ(share, 2u);
  ASSERT_EQ(0, balance("divided.yaml", "2")) << "a cell that is divided already";
  EXPECT_THAT(output, HasSubstr(key.str()));
}

// The second daemon has a cell with fewer pairs.
TEST_F(ShareBalance, IsThatOfTheLastCellWhereTheDaemonWasStartedAgainWithAnother) {
  std::string fewer = kHall;
  fewer.erase(fewer.find("  - {name: west"), fewer.find("pairs:") - fewer.find("  - {name: west"));
  write_text(folder / "fewer.yaml", fewer);
  const auto record = [&](const char* cell, const char* file) {
    ChildProcess daemon(kDaemon,
                        with({path(cell), "--record", path(file)}, dds_arguments(own_dds())));
    ASSERT_TRUE(daemon.tells("started")) << daemon.output();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    daemon.signal(SIGTERM);
    EXPECT_EQ(0, daemon.wait()) << daemon.output();
  };
  record("cell.yaml", "one.mcap");
  record("fewer.yaml", "two.mcap");
  ASSERT_EQ(0, run(kReplay, {"check", path("one.mcap"), path("two.mcap"), "--balance", "2"}))
      << output;
  const std::string both = output.substr(output.find("shares:"));
  ASSERT_EQ(0, run(kReplay, {"check", path("two.mcap"), "--balance", "2"})) << output;
  EXPECT_EQ(both, output.substr(output.find("shares:")));
}

TEST_F(ShareBalance, IsRefusedWhereAShareWouldBeEmptyOrPairsAreLeftOut) {
  EXPECT_EQ(1, balance("cell.yaml", "9"));
  EXPECT_THAT(output, HasSubstr("empty"));
  EXPECT_EQ(2, balance("cell.yaml", "0"));
  EXPECT_EQ(2, balance("cell.yaml", "2", {"--evaluate-all"})) << "it would count every pair";
}

}  // namespace
}  // namespace clearance::test
