// clearance-view beside two daemons: partners are one stream, and their states are told; others are
// mixed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <sstream>
#include <thread>

#include "tests/shared/sealed.hpp"
#include "tests/tools/made_partner.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::Not;

nlohmann::json met_by(Script& client) {
  EXPECT_EQ(client.wait(), 0) << client.output();
  const auto lines = lines_of(client);
  EXPECT_EQ(lines.size(), 1u) << client.output();
  return lines.empty() ? nlohmann::json() : lines.front();
}

// Returns what Foxglove's client has met at this address once it has these reports.
nlohmann::json shown_at(const std::string& socket, int reports) {
  Script client("foxglove", {socket, "reports", std::to_string(reports)});
  return met_by(client);
}

// The lines of `clearance-watch --plain`, one a second, from the first one with this text on.
std::vector<std::string> lines_since(const ChildProcess& watch, const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream output(watch.output());
  for (std::string line; std::getline(output, line);) {
    if (!lines.empty() || line.find(text) != std::string::npos) lines.push_back(line);
  }
  return lines;
}

class ViewOfPartners : public testing::Test {
 protected:
  CellFile file{small_cell("small")};
  Cell cell = file.cell();
  DdsOptions dds = own_dds();
  std::vector<std::string> arguments = with({file.path()}, dds_arguments(dds));

  static nlohmann::json shown(const View& view, int reports) {
    return shown_at(view.socket(), reports);
  }
  // Waits until a status has this text, and returns all statuses so far.
  static std::string told(const View& view, const std::string& text) {
    Script client("foxglove", {view.socket(), "status", text});
    return met_by(client)["statuses"].dump();
  }
};

TEST_F(ViewOfPartners, ShowsOneStreamAndSaysWhichOneIsMissing) {
  ChildProcess robot(kRobot, with(arguments, {"--rate", "200"}));
  ChildProcess left(kDaemon, with(arguments, {"--partner", "left"}));
  ASSERT_TRUE(left.tells("partner-stands", {"leading"})) << left.output();
  std::optional<ChildProcess> right(std::in_place, kDaemon,
                                    with(arguments, {"--partner", "right"}));
  ASSERT_TRUE(right->tells("partner-agrees", {"left"})) << right->output();
  ChildProcess watch(test::kWatch, with({"--plain"}, dds_arguments(dds)));
  // All of them in a second, or a number of them on a slow machine.
  const std::string agree = "partners agree|[0-9]+ agree";
  EXPECT_TRUE(eventually([&] { return std::regex_search(watch.output(), std::regex(agree)); }))
      << watch.output();
  const std::string figures = "tick p50";  // of the leader, whichever daemon the report is of
  ASSERT_TRUE(
      eventually([&] { return lines_since(watch, figures).size() >= 4; }, std::chrono::seconds(60)))
      << watch.output();
  EXPECT_THAT(lines_since(watch, figures), testing::Each(HasSubstr(figures)));
  View view(arguments);
  const nlohmann::json both = shown(view, 60);
  // Partners that a slow machine parts do not count cycles alike: times are always in order.
  const std::vector<std::int64_t> times = both["times"];
  EXPECT_EQ(std::ranges::adjacent_find(times, std::greater_equal<>()), times.end())
      << "the page shows a report once, and none after a newer one: " << both["times"];
  EXPECT_THAT(both["statuses"].dump(), Not(HasSubstr("mixed")));
  EXPECT_THAT(both["statuses"].dump(), Not(HasSubstr("different")));
  // Without a viewer for two seconds, the page would forget that there was a partner.
  Script viewer("foxglove", {view.socket(), "status", "partner 'right': missing"});
  ASSERT_TRUE(eventually([&] { return viewer.wrote("follows"); })) << viewer.output();
  right.reset();  // it is killed
  EXPECT_TRUE(eventually([&] { return watch.wrote("partner 'right': missing"); }))
      << watch.output();
  watch.signal(SIGTERM);
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_THAT(watch.output(), testing::ContainsRegex("[0-9]+ agree.*, [0-9]+ missing"));
  EXPECT_THAT(met_by(viewer)["statuses"].dump(), Not(HasSubstr("mixed")));
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_THAT(shown(view, 60)["statuses"].dump(), HasSubstr("no partner yet"));
  EXPECT_EQ(view.end(), 0);
}

TEST_F(ViewOfPartners, SaysThatOneIsAloneAndThatBitsAreDifferent) {
  ChildProcess robot(kRobot, with(arguments, {"--rate", "200"}));
  ChildProcess left(kDaemon, with(arguments, {"--partner", "left"}));
  View view(arguments);
  EXPECT_THAT(shown(view, 60)["statuses"].dump(), HasSubstr("no partner yet"));
  MadePartner partner(dds, cell);
  Participant client(dds);
  Distances reports(client, cell);
  std::atomic<bool> ends{false};
  std::thread repeats([&] {
    while (!ends) {
      if (const auto report = reports.next(); report && (*report)->partner == std::string("left"))
        partner.report(**report, [](auto& message) { message.lower_all += 0.25; });
    }
  });
  told(view, "': different");
  ends = true;
  repeats.join();
}

// One report in 40 is different, five times a second, and a line shows the last of 200.
TEST_F(ViewOfPartners, ADifferenceStaysInTheLinesOfWatchForASecond) {
  ChildProcess robot(kRobot, with(arguments, {"--rate", "200"}));
  ChildProcess left(kDaemon, with(arguments, {"--partner", "left"}));
  MadePartner partner(dds, cell);
  Participant client(dds);
  Distances reports(client, cell);
  std::atomic<bool> ends{false};
  std::thread repeats([&] {
    while (!ends) {
      const auto report = reports.next();
      if (!report || (*report)->partner != std::string("left")) continue;
      partner.report(**report, [](auto& message) {
        if (message.cycle % 40 == 0) message.lower_all += 0.25;
      });
    }
  });
  ChildProcess watch(test::kWatch, with({"--plain"}, dds_arguments(dds)));
  const std::string told = "partner 'right': different";
  EXPECT_TRUE(
      eventually([&] { return lines_since(watch, told).size() >= 6; }, std::chrono::seconds(60)))
      << watch.output();
  const auto lines = lines_since(watch, told);
  const auto has_it = [&](const std::string& line) { return line.find(told) != line.npos; };
  EXPECT_GT(2 * static_cast<std::size_t>(std::ranges::count_if(lines, has_it)), lines.size())
      << "a slow machine compares few of them\n"
      << watch.output();
  ends = true;
  repeats.join();
}

TEST_F(ViewOfPartners, StillSaysThatFiguresOfDaemonsThatAreNoneAreMixed) {
  ChildProcess robot(kRobot, with(arguments, {"--rate", "200"}));
  ChildProcess left(kDaemon, with(arguments, {"--partner", "left"}));
  View view(arguments);
  Participant other(dds);
  const dds_entity_t writer = other.writer(TopicKind::kDistances, cell.topics.distances);
  std::atomic<bool> ends{false};
  std::thread writes([&] {
    for (clearance_msg_Distances message{}; !ends; ++message.cycle) {
      message.now_ns = dds_time();
      message.scene_revision = cell.scene.revision;
      write_sealed(other, writer, message);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  told(view, "2 daemons publish here");
  ends = true;
  writes.join();
}

// A corrupt report is the newest for three pictures of the page.
TEST_F(ViewOfPartners, OfACorruptStreamSaysThatNoReportMayBeReliedOnUntilThePageIsClosed) {
  View view(arguments);
  Participant daemon(dds);
  const dds_entity_t writer = daemon.writer(TopicKind::kDistances, cell.topics.distances);
  const dds_entity_t zones = daemon.writer(TopicKind::kZones, cell.topics.zones);
  clearance_msg_ZoneState unsealed{};
  check_dds(dds_write(zones, &unsealed), "writing");
  std::atomic<bool> ends{false}, is_corrupt{true};
  std::thread writes([&] {
    clearance_msg_Distances message{};
    message.daemon = 7;
    message.period_ns = 5'000'000;
    message.scene_revision = cell.scene.revision;
    while (!ends) {
      ++message.cycle;
      message.now_ns = message.publish_ns = dds_time();
      write_sealed(daemon, writer, message);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (message.cycle % 20 != 0 || !is_corrupt) continue;
      message.lower_all = 1.0 - message.lower_all;
      dds_write(writer, &message);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  const std::string said = told(view, "no report may be relied on: corrupt, twice within an hour");
  EXPECT_THAT(said, HasSubstr("1 message of " + cell.topics.zones + " was refused"));
  is_corrupt = false;
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_THAT(shown(view, 60)["statuses"].dump(), Not(HasSubstr("relied")));
  ends = true;
  writes.join();
}

// `tools/demo --several --view` runs three shares with two partners each, and one of the six is
// killed each second. The page has reports meanwhile, and none twice. A machine that stands still
// shows once; a page that waits for daemons to be started again would do so at most kills.
TEST(ViewOfSeveral, GoesOnWhileDaemonsAreKilled) {
  const DdsOptions dds = own_dds();
  ChildProcess several(places::sources() + "/tools/several",
                       {places::programs(), "--seconds", "120", "--every", "1", "--rate", "50",
                        "--late-ms", "1000", "--domain", std::to_string(*dds.domain), "--view"});
  const std::string says = "in a browser: http://";
  ASSERT_TRUE(eventually([&] { return several.wrote(says); })) << several.output();
  std::string address = several.output();
  address = address.substr(address.find(says) + says.size());
  const auto kills = [&] {
    const std::string text = several.output(), killed = "killed the daemon";
    int count = 0;
    for (std::size_t at = 0; (at = text.find(killed, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const int before = kills();
  const nlohmann::json page = shown_at("ws://" + address.substr(0, address.find('\n')), 150);
  ASSERT_TRUE(page.is_object()) << several.output();
  const int killed = kills();
  EXPECT_GE(killed, before + 2) << several.output();
  const std::vector<std::int64_t> times = page["times"];
  const std::vector<std::uint64_t> cycles = page["cycles"];
  EXPECT_EQ(std::ranges::adjacent_find(cycles, std::greater_equal<>()), cycles.end())
      << "it shows a report once, and none after a newer one";
  int still = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    EXPECT_GE(times[i], times[i - 1]);
    still += times[i] - times[i - 1] >= 1'000'000'000;
  }
  EXPECT_LE(still, (killed - before) / 2) << "it stood still";
  // A machine that is too slow for six daemons loses cycles, which its status says.
  several.signal(SIGTERM);
  several.wait();
  EXPECT_TRUE(several.wrote(", 0 zones active without a share, 0 zones wrong")) << several.output();
}

}  // namespace
}  // namespace clearance::test
