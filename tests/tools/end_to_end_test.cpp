// A recorded stream through the real programs, over real DDS on loopback. clearance-replay
// publishes it, clearanced measures, and clearance-record listens like any client.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "monitor/recording/writer.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::Not;

// One second at 200 Hz: the right box approaches the left one to 0.2 m, stays a while, and leaves.
std::string visiting_log() {
  std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
  for (int k = 0; k < 200; ++k) {
    const int away = std::max({0, 80 - k, k - 120});
    const std::string time = std::to_string(5'000'000LL * k);
    log += time + ",left,-0.5,0,3,1,0,0,0\n";
    log += time + ",right," + std::to_string(-0.1 + 0.01 * away) + ",0,3,1,0,0,0\n";
  }
  return log;
}

std::string run(const std::string& program, const std::vector<std::string>& arguments) {
  ChildProcess child(program, arguments);
  EXPECT_EQ(child.wait(), 0) << child.output();
  return child.output();
}

// "closest: left - right, 0.2 m (0.2 to 0.2)", without the tick.
std::string closest(const std::string& output) {
  const std::size_t begin = output.find("closest: ");
  if (begin == std::string::npos) return output;
  return output.substr(begin, output.find(" at tick", begin) - begin);
}

TEST(EndToEnd, ARecordedStreamGivesOverDdsWhatItGivesOffline) {
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  write_text(folder / "cell.yaml", small_cell("small"));
  write_text(folder / "log.csv", visiting_log());
  const Cell cell = std::get<Cell>(read_cell(path("cell.yaml")));
  const DdsOptions dds = own_dds();
  const auto where = dds_arguments(dds);
  run(kRecord,
      {"--from-csv", path("log.csv"), "-o", path("log.mcap"), "--cell", path("cell.yaml")});

  ChildProcess client(kRecord, with({"-o", path("heard.mcap")}, where));
  Participant probe(dds);
  const Poses poses(probe, cell);  // never sends, and only shows which readers exist
  ASSERT_TRUE(eventually([&] { return matched_readers(poses.writer()) == 1; })) << client.output();
  ChildProcess daemon(kDaemon, with({path("cell.yaml")}, where));
  ASSERT_TRUE(eventually([&] { return matched_readers(poses.writer()) == 2; })) << daemon.output();
  run(kReplay,
      with({"publish", path("log.mcap"), "--only", "clearance/poses", "--restamp", "--wait", "20"},
           where));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  client.signal(SIGINT);
  EXPECT_EQ(client.wait(), 0) << client.output();

  const std::string offline = run(kReplay, {"check", path("log.mcap")});
  const std::string online = run(kReplay, {"check", path("heard.mcap"), "--compare-bounds"});
  EXPECT_EQ(closest(offline), "closest: left - right, 0.2 m (0.2 to 0.2)");
  EXPECT_EQ(closest(online), closest(offline));
  EXPECT_TRUE(daemon.wrote("minimum  0.200000 m in [0.200000, 0.200000], left - right"))
      << daemon.output();
  EXPECT_THAT(online, HasSubstr("reports compared"));
  EXPECT_THAT(online, Not(HasSubstr("reports are missing"))) << "a tick was lost";
  EXPECT_TRUE(daemon.wrote(" 0 reports dropped")) << daemon.output();
}

// One state every 10 ms for 0.2 s, at half a radian per second.
void record_turning_joint(const std::string& file, const Cell& cell) {
  RecordingWriter writer(file, cell.topics);
  writer.catalogue(*make_catalogue(cell), kStart);
  PoseBatch batch;
  batch.source = SourceName("arm");
  batch.scene_revision = cell.scene.revision;
  for (int k = 0; k < 20; ++k) {
    const std::int64_t now = kStart + 10 * kTick * k;
    ++batch.sequence_number;
    batch.joints = {{.variable = 0,
                     .stamp_ns = now,
                     .position = 0.005 * k,
                     .velocity = 0.5,
                     .has_velocity = true}};
    writer.write(TopicKind::kJointStates, now, now, *make_joint_states(batch, cell.scene));
  }
  ASSERT_TRUE(writer.close()) << writer.error();
}

TEST(EndToEnd, RestampedJointStatesKeepTheirScheduleAndTheirVelocitiesFollowTheRate) {
  const ScratchFolder folder;
  const std::string file = folder / "joints.mcap";
  const Cell cell{scara_cell()};
  record_turning_joint(file, cell);
  const DdsOptions dds = own_dds();
  Participant client(dds);
  const dds_entity_t reader = client.reader(TopicKind::kJointStates, cell.topics.joint_states, 64);
  run(kReplay, with({"publish", file, "--only", "clearance/joint_states", "--restamp", "--rate",
                     "2", "--wait", "20"},
                    dds_arguments(dds)));
  std::int64_t last_ns = 0;
  int heard = 0;
  for (;; ++heard) {
    Sample<clearance_msg_JointStates> states;
    if (!take_next(reader, states)) break;
    if (heard > 0) {
      EXPECT_LE(std::abs(states->stamp_ns - last_ns - 5 * kTick), 1);
    }
    last_ns = states->stamp_ns;
    EXPECT_EQ(states->velocities._buffer[0], 1.0);
  }
  EXPECT_EQ(heard, 20);
}

}  // namespace
}  // namespace clearance::test
