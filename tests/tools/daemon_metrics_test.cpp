// The metrics of a running daemon.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/monitor/publish/metrics_client.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

TEST(DaemonMetrics, GrowWithTheTicksAndNameTheInputsOfTheCell) {
  const ScratchFolder folder;
  const std::string socket = (folder / "metrics.sock").string();
  const CellFile cell(small_cell("metrics"));
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon,
                      with(with({cell.path()}, dds_arguments(dds)), {"--metrics", socket}));
  const auto scrape = [&] { return read_metrics(body_of(ask(socket, "GET", "/metrics"))); };
  ASSERT_TRUE(eventually([&] {
    return std::filesystem::exists(socket) &&
           ask(socket, "GET", "/metrics").starts_with("HTTP/1.1 200");
  })) << daemon.output();
  auto first = scrape();
  EXPECT_GE(first["clearance_ticks_total"], 200.0) << "a second at 200 Hz";
  EXPECT_EQ(first["clearance_tick_seconds_count"], first["clearance_ticks_total"]);
  EXPECT_EQ(first["clearance_input_usable input=left"], 0.0) << "no pose has come";
  EXPECT_EQ(first["clearance_pairs state=unknown"], first["clearance_pairs state=all"]);
  EXPECT_TRUE(eventually(
      [&] { return scrape()["clearance_ticks_total"] > first["clearance_ticks_total"]; }));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  EXPECT_FALSE(std::filesystem::exists(socket));
}

}  // namespace
}  // namespace clearance::test
