// clearance-view with a recording: its time line, its jumps and its pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "monitor/recording/reader.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

class ViewOfARecording : public testing::Test {
 protected:
  // Made once, since these tests only read it.
  struct Recorded {
    Recorded() {
      const DdsOptions own = own_dds();
      const auto dds = dds_arguments(own);
      ChildProcess daemon(kDaemon, with({cell.path(), "--record", file}, dds));
      ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
      wait_for_poses(own, cell.cell(), 1.2);
      daemon.signal(SIGTERM);
      EXPECT_EQ(daemon.wait(), 0) << daemon.output();
    }
    CellFile cell{small_cell("small")};
    ScratchFolder folder;
    std::string file = (folder / "run.mcap").string();
  };
  static const Recorded& recorded() {
    static const Recorded once;
    return once;
  }

  // The entry with the least distance that is not stale.
  [[nodiscard]] clearance_msg_PairDistance worst() const {
    RecordingReader reader(file);
    RecordedMessage message;
    CdrDecoder decoder;
    Sample<clearance_msg_Distances> report;
    clearance_msg_PairDistance least{};
    least.distance = kInfinity;
    while (reader.next(message)) {
      if (message.kind != TopicKind::kDistances || !decoder.decode(message.cdr, report)) continue;
      const auto& minimum = report->minimum;
      if (!report->minimum_known || minimum.status >= 5) continue;
      if (minimum.distance < least.distance) least = minimum;
    }
    return least;
  }

  const CellFile& cell = recorded().cell;
  const std::string& file = recorded().file;
};

TEST_F(ViewOfARecording, FindsTheWorstMomentAndGoesWhereItIsDragged) {
  View view({cell.path(), "--replay", file});
  PageScript page("page", {view.page(), pictures(), "recording"});
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  const std::vector<json> said = lines_of(page);
  ASSERT_EQ(said.size(), 2u) << page.output();
  const json& shown = said.front();
  EXPECT_EQ(shown["errors"], json::array());
  EXPECT_EQ(shown["worst"]["distance"], worst().distance);
  EXPECT_EQ(shown["worst"]["pair"], "left – right");
  const double duration = shown["timeline"]["duration"];
  EXPECT_NEAR(shown["dragged"], 0.73 * duration, 0.05 * duration);
  EXPECT_EQ(shown["clicked"], "left");
  EXPECT_NEAR(shown["again"], shown["dragged"], 0.002);
  EXPECT_EQ(shown["chosen"], 1);
  EXPECT_GT(said.back()["played"], shown["dragged"]);
}

TEST_F(ViewOfARecording, SaysTheSameOfReportsThatItComputesItself) {
  View recorded({cell.path(), "--replay", file});
  View computed({cell.path(), "--replay", file, "--offline"});
  json found[2];
  for (int i = 0; i < 2; ++i) {
    const View& view = i == 0 ? recorded : computed;
    Script client("foxglove", {view.socket(), "time", "1"});
    EXPECT_EQ(client.wait(), 0) << client.output();
    const std::vector<json> said = lines_of(client);
    ASSERT_EQ(said.size(), 1u) << client.output();
    found[i] = said.front();
    // The machine's clock may be corrected while the daemon runs: then no tick is at 1 s exactly.
    EXPECT_NEAR(found[i]["parameters"]["playback.time"], 1.0, 0.02);
    EXPECT_FALSE(found[i]["parameters"]["playback.playing"]);
  }
  SCOPED_TRACE(found[0]["last"]["clearance/distances"]["minimum"].dump());
  EXPECT_EQ(found[0]["last"]["/tf"]["transforms"].size(), 3u);
  EXPECT_EQ(found[0]["last"]["/tf"]["transforms"], found[1]["last"]["/tf"]["transforms"]);
  const json &first = found[0]["last"]["clearance/distances"],
             &second = found[1]["last"]["clearance/distances"];
  EXPECT_EQ(first["cycle"], second["cycle"]);
  EXPECT_EQ(first["minimum"], second["minimum"]);
  EXPECT_EQ(first["pairs"], second["pairs"]);
}

// The content of the recording's reports and zones up to this time, s after the first report.
struct Before {
  std::uint64_t cycle = 0;
  bool zone_active = false;
  double least = kInfinity;          // m
  double least_of_pair = kInfinity;  // for pair 2
  double fastest = -kInfinity;       // its closing speed, m/s
};
Before before(const std::string& file, double time_s) {
  RecordingReader reader(file);
  RecordedMessage message;
  CdrDecoder decoder;
  Sample<clearance_msg_Distances> report;
  Sample<clearance_msg_ZoneState> zone;
  Before found;
  std::int64_t begin_ns = 0;
  while (reader.next(message)) {
    if (begin_ns != 0 && message.log_ns > begin_ns + std::llround(1e9 * time_s)) break;
    if (message.kind == TopicKind::kZones && decoder.decode(message.cdr, zone)) {
      found.zone_active = zone->active;
    } else if (message.kind == TopicKind::kDistances && decoder.decode(message.cdr, report)) {
      if (begin_ns == 0) begin_ns = message.log_ns;
      found.cycle = report->cycle;
      if (!report->minimum_known || report->minimum.status >= 5) continue;
      found.least = std::min(found.least, report->minimum.distance);
      found.least_of_pair = std::min(found.least_of_pair, report->pairs._buffer[2].distance);
      const double speed = report->pairs._buffer[2].closing_speed;
      if (!std::isnan(speed)) found.fastest = std::max(found.fastest, speed);
    }
  }
  return found;
}

// The known values of a curve.
std::vector<double> known_in(const json& curve) {
  std::vector<double> known;
  for (const json& value : curve) {
    if (!value.is_null()) known.push_back(value);
  }
  return known;
}
double least_in(const json& curve) { return std::ranges::min(known_in(curve)); }

// The jumps lead to times between ticks. A report less than a microsecond later counts as the one
// of that time.
TEST_F(ViewOfARecording, AJumpBringsTheZonesAndTheHistoryOfItsMoment) {
  View view({cell.path(), "--replay", file});
  Script client("jump", {view.socket(), "1.1024", "0.3021", "0.9023", "0.5022"});
  EXPECT_EQ(client.wait(), 0) << client.output();
  const std::vector<json> said = lines_of(client);
  ASSERT_EQ(said.size(), 4u) << client.output();
  for (const json& each : said) {
    SCOPED_TRACE(each["time"].dump());
    const Before truth = before(file, each["time"]);
    EXPECT_EQ(each["cycle"], truth.cycle);
    EXPECT_EQ(each["zone"]["active"], truth.zone_active);
    const json& history = each["history"];
    ASSERT_GT(history["s"].size(), 20u);
    EXPECT_LE(history["s"].back(), each["time"].get<double>() + 0.02);
    EXPECT_EQ(least_in(history["distance"]), truth.least);
    EXPECT_NEAR(least_in(history["pairs"]["2"]), truth.least_of_pair, 1e-6);
    EXPECT_NEAR(std::ranges::max(known_in(history["speeds"]["2"])), truth.fastest, 1e-6);
  }
}

TEST_F(ViewOfARecording, WritesPicturesOfTheTimesThatAreAskedFor) {
  const std::string first = pictures() + "/asked-0.png", second = pictures() + "/asked-1.png";
  ChildProcess view(kView, {cell.path(), "--replay", file, "--force", "--screenshot", first, "--at",
                            "0.5", "--screenshot", second, "--at", "1", "--width", "1024"});
  EXPECT_EQ(view.wait(), 0) << view.output();
  for (const std::string& picture : {first, second}) {
    EXPECT_GT(std::filesystem::file_size(picture), 20'000u);
  }
}

}  // namespace
}  // namespace clearance::test
