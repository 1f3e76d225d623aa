// The official JavaScript reader reads the project's recordings. CTest first installs its packages
// (tests/CMakeLists.txt).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

json read_officially(const std::filesystem::path& file) {
  const std::string command =
      "node " + test::places::mcap_js() + "/read.mjs '" + file.string() + "' 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string output;
  std::array<char, 65536> piece;
  while (const std::size_t read = std::fread(piece.data(), 1, piece.size(), pipe)) {
    output.append(piece.data(), read);
  }
  EXPECT_EQ(0, pclose(pipe)) << output;
  return json::parse(output, nullptr, false);
}

class OfficialReader : public testing::Test {
 protected:
  OfficialReader() {
    cell.yaml = "name: bench # \xc3\xa9\n";
    record_run(cell, file, {.ticks = 500, .nearest = 0.05});
    messages = messages_of(file);
    read = read_officially(file);
  }
  ScratchFolder folder;
  Cell cell{bench_cell()};
  std::filesystem::path file = folder / "run.mcap";
  std::vector<Kept> messages;
  json read;
};

TEST_F(OfficialReader, FindsEveryMessageStreamedAndIndexed) {
  for (const char* how : {"streamed", "indexed"}) {
    ASSERT_EQ(messages.size(), read[how]["order"].size()) << how;
    for (const Topic& topic : kRecordedTopics) {
      const auto ours = std::ranges::count(messages, topic.kind, &Kept::kind);
      if (ours == 0) continue;
      const json& theirs = read[how]["topics"][Topics{}.*topic.name];
      EXPECT_EQ(ours, theirs["messages"]) << how;
      EXPECT_EQ(theirs["type"], topic_schema(topic.kind).name);
    }
  }
  EXPECT_EQ(read["streamed"]["order"], read["indexed"]["order"]);
}

TEST_F(OfficialReader, SeeksThroughTheIndex) {
  const auto middle = read["middle"].get<double>();
  const auto late = std::ranges::count_if(messages, [middle](const Kept& message) {
    return static_cast<double>(message.log_ns) >= middle;
  });
  EXPECT_EQ(late, read["second_half"]);
  EXPECT_GT(late, 200);
  EXPECT_GT(read["indexed"]["statistics"]["chunkCount"], 2);
  EXPECT_EQ(json::array({"zstd"}), read["indexed"]["compressions"]);
  EXPECT_EQ(read["indexed"]["metadata"][std::string(kRecordingMetadata)]["cell"], cell.yaml);
}

TEST_F(OfficialReader, DecodesEveryFieldByTheSchemaInTheFile) {
  const Kept& last =
      *std::ranges::find(messages.rbegin(), messages.rend(), TopicKind::kDistances, &Kept::kind);
  const auto report = decoded<clearance_msg_Distances>(last);
  const json& theirs = read["indexed"]["topics"]["clearance/distances"]["last"];
  EXPECT_EQ(500, theirs["cycle"]);
  EXPECT_EQ(report->minimum_known, theirs["minimum_known"]);
  EXPECT_EQ(report->minimum.lower, theirs["minimum"]["lower"]);
  EXPECT_EQ(report->minimum.witness_b.z, theirs["minimum"]["witness_b"]["z"]);
  ASSERT_EQ(report->pairs._length, theirs["pairs"].size());
  EXPECT_EQ(report->pairs._buffer[1].distance, theirs["pairs"][1]["distance"]);
  EXPECT_EQ(report->pairs._buffer[1].status, theirs["pairs"][1]["status"]);
  EXPECT_EQ(report->pairs._buffer[1].evaluated_cycle, theirs["pairs"][1]["evaluated_cycle"]);

  // Only one pose of each object has arrived, so the closing speed is unknown.
  const json& first = read["streamed"]["topics"]["clearance/distances"]["first"];
  EXPECT_EQ("NaN", first["minimum"]["closing_speed"]);
  EXPECT_EQ("NaN", first["minimum"]["time_to_contact"]);
  EXPECT_EQ(report->minimum.closing_speed, theirs["minimum"]["closing_speed"]);

  const auto batch = decoded<clearance_msg_PoseBatch>(
      *std::ranges::find(messages, TopicKind::kPoses, &Kept::kind));
  const json& poses = read["streamed"]["topics"]["clearance/poses"]["first"];
  EXPECT_EQ(batch->source, poses["source"]);
  ASSERT_EQ(1u, poses["poses"].size());
  EXPECT_EQ(batch->poses._buffer[0].position.z, poses["poses"][0]["position"]["z"]);
  EXPECT_EQ(batch->poses._buffer[0].orientation.w, poses["poses"][0]["orientation"]["w"]);
  EXPECT_EQ(false, poses["poses"][0]["has_twist"]);

  const json& catalogue = read["streamed"]["topics"]["clearance/catalogue"]["first"];
  EXPECT_EQ(catalogue["cell_yaml"], cell.yaml);
  EXPECT_EQ("box", catalogue["objects"][2]["name"]);
  EXPECT_EQ("block", catalogue["objects"][2]["parts"][0]);
  EXPECT_EQ("stop", read["streamed"]["topics"]["clearance/zones"]["first"]["name"]);
}

}  // namespace
}  // namespace clearance::test
