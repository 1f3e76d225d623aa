// The outputs of a cell for ROS 2, through real DDS on loopback. The test acts as the tick thread.
#include "monitor/publish/ros_writer.hpp"

#include <gtest/gtest.h>

#include <ctime>
#include <map>

#include "monitor/app/log.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/publish/health.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/logged.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/ros_reader.hpp"

namespace clearance {
namespace {

using test::eventually;
using test::RosReader;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using Float64 = std_msgs_msg_dds__Float64_;

// A ball that approaches a post at x = 1, with all outputs.
Cell told_cell() {
  Cell cell;
  Scene& scene = cell.scene;
  scene = test::cell_of({test::moving("ball", {test::ball(0.1)}),
                         test::fixed("post", {test::ball(0.1)}, test::at(1, 0, 0))});
  scene.name = "told";
  scene.pairs[0].publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  for (const RosOutput& output : kRosOutputs)
    cell.ros.outputs.*output.topic = "/told" + std::string(output.standard_topic);
  cell.ros.markers_hz = 1000.0;
  return cell;
}

class RosWriterTest : public testing::Test {
 protected:
  void tick(double x) {
    const PoseSample sample = test::sample(0, test::at(x, 0, 0), now += test::kTick);
    hand_over(monitor.tick({&sample, 1}, now));
  }
  void hand_over(const Report& report) { ros.report(report, {}); }
  void tell_statistics(std::int64_t age_ns) {
    LoopStatistics statistics(scene);
    statistics.ages[0].age_ns = age_ns;
    statistics.ages[0].stale = age_ns > 20'000'000;
    ros.statistics(statistics);
  }

  Cell cell = told_cell();
  Scene& scene = cell.scene;
  DdsOptions dds = test::own_dds();
  Participant participant{dds}, client{dds};
  PoseReader poses{cell, participant};
  ReportQueue published{scene, {}};
  RecordingHealth recording;
  RosWriter ros{cell, participant, [this](const LoopStatistics& statistics) {
                  return make_health(scene, statistics, poses, published.dropped_reports(),
                                     recording);
                }};
  Monitor monitor{scene};
  std::int64_t now = test::kStart;
};

// At x = 0 the distance of the surfaces is 0.8 m. The zone begins at 0.3 m.
TEST_F(RosWriterTest, NumbersAreTheLeastLowerBoundAndTheScalingOfTheZones) {
  RosReader<Float64> minimum(client, kRosFloat64, "rt/told/clearance/minimum_distance");
  RosReader<Float64> scaling(client, kRosFloat64, "rt/told/clearance/speed_scaling");
  hand_over(monitor.tick({}, now));
  EXPECT_TRUE(eventually([&] {
    hand_over(monitor.tick({}, now += test::kTick));
    return minimum.take() && scaling.take();
  }));
  EXPECT_EQ(minimum.last().data, -kInfinity) << "the ball was never seen";
  EXPECT_EQ(scaling.last().data, 0.0);
  EXPECT_TRUE(eventually([&] {
    tick(0.0);
    return scaling.take() && scaling.last().data == 1.0;
  }));
  EXPECT_TRUE(eventually([&] { return minimum.take() && minimum.last().data > 0.0; }));
  EXPECT_NEAR(minimum.last().data, 0.8, 1e-12);
  EXPECT_LE(minimum.last().data, 0.8);
  EXPECT_TRUE(eventually([&] {
    tick(0.6);
    return scaling.take() && scaling.last().data == 0.0;
  }));
}

TEST_F(RosWriterTest, TheScalingOfZonesIsNothingWhileAPairOverlapsOrIsUnknown) {
  RosReader<Float64> scaling(client, kRosFloat64, "rt/told/clearance/speed_scaling");
  const auto comes = [&](double value, const auto& tick_once) {
    return eventually([&] {
      tick_once();
      return scaling.take() && scaling.last().data == value;
    });
  };
  EXPECT_TRUE(comes(1.0, [&] { tick(0.0); }));
  EXPECT_TRUE(comes(0.0, [&] { tick(0.95); })) << "the ball is in the post";
  EXPECT_TRUE(comes(1.0, [&] { tick(0.0); }));
  now += 1'000'000'000;
  EXPECT_TRUE(comes(0.0, [&] { hand_over(monitor.tick({}, now += test::kTick)); }));
}

// A controller takes one number: the zone of this cell is distance alone.
TEST_F(RosWriterTest, TheScalingIsTheLeastOfAllStops) {
  RosReader<Float64> scaling(client, kRosFloat64, "rt/told/clearance/speed_scaling");
  const auto comes = [&](double first, double second) {
    return eventually([&] {
      const PoseSample sample = test::sample(0, test::at(0.0, 0, 0), now += test::kTick);
      Report report = monitor.tick({&sample, 1}, now);
      report.stops = {{.robot = 0, .scaling = first}, {.robot = 1, .scaling = second}};
      hand_over(report);
      return scaling.take() && scaling.last().data == std::min(first, second);
    });
  };
  EXPECT_TRUE(comes(0.75, 0.25));
  EXPECT_TRUE(comes(0.5, 1.0));
  EXPECT_TRUE(comes(0.0, 1.0));
}

TEST_F(RosWriterTest, LinesOfTheLogAreThereForALateReaderWithTheirCodesAndLevels) {
  (void)kept_lines();
  log_line(lines::kStopped, "a test");
  log_line(lines::kSystemRefuses, "a request of a test");
  tell_statistics(0);
  RosReader<rcl_interfaces_msg_dds__Log_> lines(client, kRosLog, "rt/told/rosout");
  ASSERT_TRUE(eventually([&] { return lines.take(); }));
  EXPECT_STREQ(lines.last().msg, "stopped after a test [stopped]");
  EXPECT_EQ(lines.last().name, log_name());
  EXPECT_EQ(lines.last().level, 20);
  EXPECT_NEAR(lines.last().stamp.sec, static_cast<double>(std::time(nullptr)), 60.0);
  ASSERT_TRUE(eventually([&] { return lines.take(); }));
  EXPECT_STREQ(lines.last().msg, "a request of a test [system-refuses]");
  EXPECT_EQ(lines.last().level, 30);
}

TEST_F(RosWriterTest, TheSceneIsThereForALateReader) {
  tick(0.0);
  RosReader<moveit_msgs_msg_dds__PlanningScene_> scene_reader(
      client, kRosMonitoredScene, "rt/told/clearance/monitored_planning_scene");
  ASSERT_TRUE(eventually([&] { return scene_reader.take(); }));
  const moveit::PlanningScene heard = moveit::from_wire(scene_reader.last());
  ASSERT_EQ(heard.collision_objects.size(), 1u);
  EXPECT_EQ(heard.collision_objects[0].id, "post");
}

TEST(RosWriter, PublishesNoScalingInACellWithoutZones) {
  Cell cell = told_cell();
  cell.scene.zones.clear();
  const DdsOptions dds = test::own_dds();
  Participant participant(dds), client(dds);
  RosReader<Float64> minimum(client, kRosFloat64, "rt/told/clearance/minimum_distance");
  RosReader<Float64> scaling(client, kRosFloat64, "rt/told/clearance/speed_scaling");
  const auto log = std::make_shared<test::Logged>();
  const test::LoggedTo logged(log);
  RosWriter ros(cell, participant, [](const LoopStatistics&) { return std::nullopt; });
  EXPECT_TRUE(log->has("[no-speed-scaling]"));
  EXPECT_TRUE(log->has("/told/clearance/speed_scaling"));
  Monitor monitor(cell.scene);
  std::int64_t now = test::kStart;
  ASSERT_TRUE(eventually([&] {
    ros.report(monitor.tick({}, now += test::kTick), {});
    return minimum.take();
  }));
  EXPECT_EQ(test::matched_writers(scaling.handle()), 0u);
  EXPECT_FALSE(scaling.take());
}

TEST_F(RosWriterTest, MarkersAreTheBodiesOnceAReaderComesAndThenTheClosestPair) {
  for (int readers = 0; readers < 2; ++readers) {
    RosReader<MarkerArray> markers(client, kRosMarkers, "rt/told/clearance/markers");
    const auto has = [&](const std::string& name_space) {
      return eventually([&] {
        tick(0.5);
        return markers.take() && markers.last().markers._length > 0 &&
               name_space == markers.last().markers._buffer[0].ns;
      });
    };
    ASSERT_TRUE(has("bodies"));
    EXPECT_EQ(markers.last().markers._length, 2u);
    EXPECT_STREQ(markers.last().markers._buffer[0].header.frame_id, "ball");
    EXPECT_STREQ(markers.last().markers._buffer[1].header.frame_id, "world") << "it is fixed";
    EXPECT_EQ(markers.last().markers._buffer[1].pose.position.x, 1.0);
    ASSERT_TRUE(has("lines"));
    const auto& line = markers.last().markers._buffer[0];
    ASSERT_EQ(line.points._length, 2u);
    EXPECT_NEAR(line.points._buffer[1].x - line.points._buffer[0].x, 0.3, 1e-9);
    const std::vector<std::uint64_t> writers = writers_of(markers.handle());
    ASSERT_EQ(writers.size(), 1u);
    EXPECT_EQ(writer_facts(markers.handle(), writers[0]).user_data,
              "typehash=RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf;");
  }
}

TEST_F(RosWriterTest, DiagnosticsSayWhatIsLateAndWhichZoneIsActive) {
  RosReader<DiagnosticArray> diagnostics(client, kRosDiagnostics, "rt/told/diagnostics");
  std::map<std::string, std::pair<int, std::string>> said;
  const auto says = [&](const std::string& name, DiagnosticLevel level, std::int64_t age_ns,
                        double x) {
    return eventually([&] {
      tick(x);
      tell_statistics(age_ns);
      if (!diagnostics.take()) return false;
      for (std::uint32_t i = 0; i < diagnostics.last().status._length; ++i) {
        const auto& status = diagnostics.last().status._buffer[i];
        said[status.name] = {status.level, status.message};
      }
      return said["clearance told: " + name].first == static_cast<int>(level);
    });
  };
  EXPECT_TRUE(says("poses", DiagnosticLevel::kError, -1, 0.0));
  EXPECT_EQ(said["clearance told: poses"].second, "ball was never seen");
  EXPECT_TRUE(says("poses", DiagnosticLevel::kWarn, 1'000'000'000, 0.0));
  EXPECT_EQ(said["clearance told: poses"].second, "ball is late");
  EXPECT_TRUE(says("poses", DiagnosticLevel::kOk, 1'000'000, 0.0));
  EXPECT_TRUE(says("zone zone", DiagnosticLevel::kWarn, 1'000'000, 0.6));
  EXPECT_EQ(said["clearance told: zone zone"].second, "active: ball - post, by distance");
  EXPECT_TRUE(says("zone zone", DiagnosticLevel::kOk, 1'000'000, 0.0));
}

// The reader is reliable and volatile and never takes a sample. Writing continues for the others.
TEST_F(RosWriterTest, AReaderThatStandsStillDelaysNothing) {
  const dds_entity_t stopped = client.ros_reader(kRosMarkers, "rt/told/clearance/markers");
  const dds_entity_t other = client.ros_reader(kRosFloat64, "rt/told/clearance/minimum_distance");
  ASSERT_TRUE(eventually(
      [&] { return test::matched_writers(stopped) > 0 && test::matched_writers(other) > 0; }));
  for (int i = 0; i < 5'000; ++i) tick(4e-5 * i);
  RosReader<Float64> minimum(client, kRosFloat64, "rt/told/clearance/minimum_distance");
  EXPECT_TRUE(eventually([&] {
    tick(0.2);
    return minimum.take() && std::abs(minimum.last().data - 0.6) < 1e-9;
  }));
}

}  // namespace
}  // namespace clearance
