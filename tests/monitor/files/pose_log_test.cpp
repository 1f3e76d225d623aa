#include "monitor/files/pose_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <random>

#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/mistake_at.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

constexpr const char* kPoseHeader = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";

class CsvPoses : public testing::Test {
 protected:
  ScratchFolder folder;

  std::vector<CsvPose> read(const std::string& text) {
    write_text(folder / "log.csv", text);
    CsvPoseLog log(folder / "log.csv");
    std::vector<CsvPose> poses;
    CsvPose pose;
    while (log.next(pose)) poses.push_back(pose);
    error = log.error();
    return poses;
  }
  std::string error;
};

TEST_F(CsvPoses, FindsColumnsByNameInAnyOrderAndIgnoresOthers) {
  const auto poses = read(
      "\xef\xbb\xbfnote,qz, qy,qx,qw,pz,py,px,\"object\",t_ns\r\n"
      "x,0.1,0.2,0.3,0.9,3,2,1,\"hand\",17\r\n"
      "\r\n"
      "y,0.1,0.2,0.3,0.9,3,2,1e-3,hand,18");
  EXPECT_EQ("", error);
  ASSERT_EQ(2u, poses.size());
  EXPECT_EQ(17, poses[0].t_ns);
  EXPECT_EQ("hand", poses[0].object);
  EXPECT_EQ(Vec3(1, 2, 3), poses[0].world_from_object.position);
  EXPECT_EQ(0.9, poses[0].world_from_object.orientation.w());
  EXPECT_EQ(0.1, poses[0].world_from_object.orientation.z());
  EXPECT_EQ(1e-3, poses[1].world_from_object.position.x());
}

TEST_F(CsvPoses, RefuseALineThatDoesNotEnd) {
  const std::string row = std::string(kPoseHeader) + "5,hand,1,2,3,1,0,0,0\n";
  for (const char byte : {'7', ' ', '\0'}) {
    gzFile file = gzopen((folder / "log.csv.gz").c_str(), "wb");
    const std::string text = row + std::string(std::size_t{8} << 20, byte);
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
    CsvPoseLog log(folder / "log.csv.gz");
    CsvPose pose;
    EXPECT_TRUE(log.next(pose));
    EXPECT_FALSE(log.next(pose));
    EXPECT_THAT(log.error(), mistake_at("log.csv.gz:3", "1 MiB"));
  }
}

TEST_F(CsvPoses, ReadLinesThatCrossTheBuffer) {
  std::string text = kPoseHeader;
  for (int i = 0; i < 5000; ++i) {
    text += std::to_string(i) + ",hand,1,2," + std::to_string(i) + ",1,0,0,0\n";
  }
  const auto poses = read(text);
  EXPECT_EQ("", error);
  ASSERT_EQ(5000u, poses.size());
  for (int i = 0; i < 5000; ++i) {
    EXPECT_EQ(i, poses[static_cast<std::size_t>(i)].world_from_object.position.z());
  }
}

// Opening one for reading waits for a program that writes.
TEST_F(CsvPoses, AFifoIsRefusedWithoutWaiting) {
  const std::string fifo = (folder / "log.csv").string();
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  CsvPoseLog log(fifo);
  CsvPose pose;
  EXPECT_FALSE(log.next(pose));
  EXPECT_THAT(log.error(), HasSubstr(fifo));
}

TEST_F(CsvPoses, ReadsGzipAndPlainAlike) {
  const std::string text = std::string(kPoseHeader) + "5,hand,1,2,3,1,0,0,0\n";
  gzFile file = gzopen((folder / "log.csv.gz").c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  CsvPoseLog log(folder / "log.csv.gz");
  CsvPose pose;
  ASSERT_TRUE(log.next(pose));
  EXPECT_EQ(5, pose.t_ns);
  EXPECT_FALSE(log.next(pose));
  EXPECT_EQ("", log.error());
}

TEST_F(CsvPoses, GzipCutOffIsAnErrorWithALine) {
  std::string text = kPoseHeader;
  std::mt19937_64 random(1);
  for (int i = 0; i < 5000; ++i) {
    text += std::to_string(i) + ",hand,0." + std::to_string(random()) + ",2,3,1,0,0,0\n";
  }
  gzFile file = gzopen((folder / "log.csv.gz").c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  const std::string whole = read_text(folder / "log.csv.gz");
  write_text(folder / "log.csv.gz", whole.substr(0, whole.size() / 2));
  CsvPoseLog log(folder / "log.csv.gz");
  CsvPose pose;
  int rows = 0;
  while (log.next(pose)) ++rows;
  EXPECT_LT(rows, 5000);
  EXPECT_THAT(log.error(), HasSubstr("log.csv.gz:"));
}

TEST_F(CsvPoses, EveryErrorNamesItsLine) {
  const struct {
    const char* rows;
    const char* error;
  } cases[] = {
      {"1,hand,1,2,3,1,0,0,0\n1,hand,1,2,3,1,0,0\n",
       "log.csv:3: has 8 fields; expected 9, as the header names"},
      {"1,hand,1,2,3,1,0,0,zero\n", "log.csv:2: qz is 'zero'; expected a finite number"},
      {"1,hand,nan,2,3,1,0,0,0\n", "log.csv:2: px is 'nan'; expected a finite number"},
      {"1,hand,1,2,3,1,0,0,0x\n", "log.csv:2: qz is '0x'"},
      {"1.5,hand,1,2,3,1,0,0,0\n", "log.csv:2: t_ns is '1.5'"},
      {"-1,hand,1,2,3,1,0,0,0\n", "log.csv:2: t_ns is '-1'; expected whole nanoseconds, 0 or more"},
      {"2,hand,1,2,3,1,0,0,0\n1,hand,1,2,3,1,0,0,0\n", "log.csv:3: t_ns goes back from 2 to 1"},
      {"1,,1,2,3,1,0,0,0\n", "log.csv:2: names no object"},
  };
  for (const auto& c : cases) {
    read(std::string(kPoseHeader) + c.rows);
    EXPECT_THAT(error, HasSubstr(c.error));
  }
  read("t_ns,object,px,py,pz,qx,qy,qz\n");
  EXPECT_THAT(error, mistake_at("log.csv:1", "'qw'"));
  read("");
  EXPECT_THAT(error, mistake_at("log.csv:1", "t_ns,object,"));
  read("t_ns,object,px,py,px,pz,qw,qx,qy,qz\n");
  EXPECT_THAT(error, mistake_at("log.csv:1", "'px'"));
}

}  // namespace
}  // namespace clearance::test
