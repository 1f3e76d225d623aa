#include "monitor/recording/csv_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHeader = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";

class CsvRecording : public testing::Test {
 protected:
  ScratchFolder folder;
};

TEST_F(CsvRecording, RecordingHoldsOneBatchATimeWithTheIdsOfTheCell) {
  const Cell cell{bench_cell()};  // hand, tool, box (fixed)
  write_text(folder / "log.csv",
             std::string(kHeader) +
                 "5,tool,1,2,3,1,0,0,0\n5,box,0,0,0,1,0,0,0\n5,hand,4,5,6,1,0,0,0\n"
                 "6,tool,1,2,3,1,0,0,0\n");
  const CsvRecordingResult result = record_csv(folder / "log.csv", folder / "a.mcap", &cell);
  EXPECT_EQ("", result.error);
  EXPECT_EQ(4u, result.rows);
  EXPECT_EQ(2u, result.samples);
  EXPECT_THAT(result.fixed_objects, ElementsAre("box"));
  const auto messages = messages_of(folder / "a.mcap");
  ASSERT_EQ(3u, messages.size());
  EXPECT_EQ(41u, decoded<clearance_msg_Catalogue>(messages[0])->scene_revision);
  const auto first = decoded<clearance_msg_PoseBatch>(messages[1]);
  EXPECT_EQ(5, messages[1].log_ns);
  EXPECT_EQ(1u, first->sequence_number);
  ASSERT_EQ(2u, first->poses._length);
  EXPECT_EQ(1u, first->poses._buffer[0].object);
  EXPECT_EQ(0u, first->poses._buffer[1].object);
  EXPECT_EQ(6.0, first->poses._buffer[1].position.z);
  EXPECT_EQ(5, first->poses._buffer[1].stamp_ns);
  EXPECT_EQ(2u, decoded<clearance_msg_PoseBatch>(messages[2])->sequence_number);
}

TEST_F(CsvRecording, WithoutACellObjectsAreNamedInTheOrderOfAppearance) {
  write_text(
      folder / "log.csv",
      std::string(kHeader) + "5,tool,1,2,3,1,0,0,0\n6,hand,4,5,6,1,0,0,0\n6,tool,1,2,3,1,0,0,0\n");
  const CsvRecordingResult result = record_csv(folder / "log.csv", folder / "a.mcap", nullptr);
  EXPECT_THAT(result.objects, ElementsAre("tool", "hand"));
  const auto catalogue = decoded<clearance_msg_Catalogue>(messages_of(folder / "a.mcap")[0]);
  ASSERT_EQ(2u, catalogue->objects._length);
  EXPECT_STREQ("tool", catalogue->objects._buffer[0].name);
  EXPECT_STREQ("hand", catalogue->objects._buffer[1].name);
}

TEST_F(CsvRecording, StoppedInTheMiddleItSaysHowFarItCame) {
  std::string log = kHeader;
  for (int row = 0; row < 3000; ++row) log += std::to_string(row) + ",tool,1,2,3,1,0,0,0\n";
  write_text(folder / "log.csv", log);
  const auto stopped_when_asked = [this](int times) {
    return record_csv(folder / "log.csv", folder / "a.mcap", nullptr, {},
                      [times]() mutable { return --times == 0; });
  };
  const CsvRecordingResult checking = stopped_when_asked(2);
  EXPECT_THAT(checking.error, HasSubstr("stopped after 1024 rows of "));
  EXPECT_FALSE(checking.begun);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mcap"));
  const CsvRecordingResult writing = stopped_when_asked(6);
  EXPECT_THAT(writing.error, HasSubstr("stopped after 2048 of 3000 rows of "));
  EXPECT_TRUE(writing.begun);
}

TEST_F(CsvRecording, APoseThatTheDaemonWouldRefuseIsRefusedWithItsLine) {
  const auto fault = [this](const std::string& pose) {
    write_text(folder / "log.csv", std::string(kHeader) + "5,tool,1,2,3,1,0,0,0\n6,tool," + pose);
    return record_csv(folder / "log.csv", folder / "a.mcap", nullptr).error;
  };
  EXPECT_THAT(fault("1,2,3,0,0,0,0\n"), mistake_at("log.csv:3", "(qw, qx, qy, qz)", "length 0;"));
  EXPECT_THAT(fault("1,2,3,1,1,0,0\n"), mistake_at("log.csv:3", "(qw, qx, qy, qz)", "1.41421"));
  EXPECT_THAT(fault("1,2,3,1.0011,0,0,0\n"), mistake_at("log.csv:3", "(qw, qx, qy, qz)"));
  EXPECT_THAT(fault("1,2,3,1e200,0,0,0\n"), mistake_at("log.csv:3", "(qw, qx, qy, qz)"));
  EXPECT_THAT(fault("1,2e9,3,1,0,0,0\n"), mistake_at("log.csv:3", "2e+09 m"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mcap"));
  EXPECT_EQ("", fault("1,2,3,1.0009,0,0,0\n"));
}

TEST_F(CsvRecording, ObjectThatTheCellLacksIsNamedWithItsLineAndNothingIsWritten) {
  const Cell cell{bench_cell()};
  write_text(folder / "log.csv",
             std::string(kHeader) + "5,tool,1,2,3,1,0,0,0\n6,hnad,4,5,6,1,0,0,0\n");
  const CsvRecordingResult result = record_csv(folder / "log.csv", folder / "a.mcap", &cell);
  EXPECT_THAT(result.error, mistake_at("log.csv:3", "'hnad'", "'hand'"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mcap"));
}

}  // namespace
}  // namespace clearance::test
