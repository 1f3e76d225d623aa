// The metrics of a daemon on the view's port, read by Prometheus' own Python library.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "tests/monitor/publish/metrics_client.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

struct Answer {
  int status = 0;
  std::string type, body;
};

// A GET by a client that is not ours.
Answer get(const std::string& address) {
  const std::string script =
      "import sys, urllib.request, urllib.error\n"
      "try: answer = urllib.request.urlopen(sys.argv[1], timeout=10)\n"
      "except urllib.error.HTTPError as error: answer = error\n"
      "sys.stdout.write(f'{answer.status}\\n{answer.headers[\"Content-Type\"]}\\n')\n"
      "sys.stdout.flush()\n"
      "sys.stdout.buffer.write(answer.read())\n";
  ChildProcess python("/usr/bin/python3", {"-c", script, address});
  EXPECT_EQ(python.wait(), 0) << python.output();
  const std::string output = python.output();
  const std::size_t first = output.find('\n'), second = output.find('\n', first + 1);
  return {std::stoi(output), output.substr(first + 1, second - first - 1),
          output.substr(second + 1)};
}

TEST(ViewMetrics, AreThoseOfTheDaemonWithItsHistogramsAndNoneWhenItHasEnded) {
  const ScratchFolder folder;
  const std::string socket = (folder / "metrics.sock").string();
  const CellFile cell(small_cell("metrics"));
  const auto dds = dds_arguments(own_dds());
  const View view(with(with({cell.path()}, {"--metrics", socket}), dds));
  const std::string address = view.page() + "metrics";
  EXPECT_EQ(get(address).status, 502) << "no daemon yet";

  ChildProcess daemon(kDaemon, with(with({cell.path()}, dds), {"--metrics", socket}));
  ASSERT_TRUE(eventually([&] { return get(address).status == 200; })) << daemon.output();
  const Answer answer = get(address + "?any=query");
  EXPECT_EQ(answer.status, 200);
  EXPECT_TRUE(answer.type.starts_with("text/plain; version=0.0.4")) << answer.type;
  auto read = read_metrics(answer.body);
  EXPECT_GE(read["clearance_ticks_total"], 200.0) << "a second at 200 Hz";
  EXPECT_EQ(read["clearance_tick_seconds_count"], read["clearance_ticks_total"]);
  EXPECT_EQ(get(view.page()).status, 200) << "the page is served as ever";

  daemon.signal(SIGSTOP);
  EXPECT_EQ(get(address).status, 502) << "hanging";
  daemon.signal(SIGCONT);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  const Answer ended = get(address);
  EXPECT_EQ(ended.status, 502);
  EXPECT_NE(ended.body.find(socket), std::string::npos) << ended.body;
}

// No page is open. A second request after a pause rests on a newer report.
TEST(ViewDistance, IsKnownToAProgramWithoutAPageAndUnknownOnceTheDaemonIsSilent) {
  RunningSmallCell running;
  const View view(running.arguments());
  const auto asked = [&] {
    return nlohmann::json::parse(get(view.page() + "distance.json?a=0&b=1").body);
  };
  for (int i = 0; i < 2; ++i) {
    const nlohmann::json found = asked();
    EXPECT_TRUE(found["lower"].is_number() && found["upper"].is_number()) << found;
    EXPECT_GE(found["age_a_ns"], 0) << found;
    EXPECT_GE(found["age_b_ns"], 0) << found;
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));  // readers stay for 2 s
  }
  running.daemon.signal(SIGTERM);
  EXPECT_EQ(running.daemon.wait(), 0) << running.daemon.output();
  EXPECT_TRUE(asked()["lower"].is_null());
}

TEST(ViewMetrics, AreNotServedWithoutTheOption) {
  const CellFile cell(small_cell("metrics"));
  const View view(with({cell.path()}, dds_arguments(own_dds())));
  EXPECT_EQ(get(view.page() + "metrics").status, 404);
}

}  // namespace
}  // namespace clearance::test
