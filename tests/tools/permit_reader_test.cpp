// Permits of the reader beside a daemon. The oracle: closed forms, as the box stands at a known
// height.
#include "tools/ros2/clearance_control/permit_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance_control {
namespace {

namespace test = clearance::test;
namespace client = clearance::client;
using clearance::ReportError;

// A box that is 1 m above a floor, unless a test moves it, and one that is far away.
constexpr const char* kCell = R"(
name: permits
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 400}
objects:
  - {name: hand, box: {size: [0.2, 0.2, 0.2]}}
  - {name: tool, box: {size: [0.2, 0.2, 0.2]}}
  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}
pairs:
  - {between: [hand, floor], publish: true}
  - {between: [tool, floor], publish: true}
zones:
  - {name: low, between: [hand, floor], enter_below: 0.3, leave_above: 0.31}
simulation:
  movers:
    - {object: hand, centre: {xyz: [0, 0, 1.1]}, amplitude: [0, 0, 0], frequency_hz: 1}
    - {object: tool, centre: {xyz: [2, 0, 5]}, amplitude: [0, 0, 0], frequency_hz: 1}
)";

class PermitReaderTest : public testing::Test {
 protected:
  PermitReaderTest() { options.stream.period = std::chrono::milliseconds(400); }

  void read() {
    reader.emplace(dds, options, [this](const std::string& cause) {
      const std::lock_guard lock(mutex);
      told.push_back(cause);
    });
  }
  // Sends poses at this height until the permit is so. They have no twists: a stated standstill
  // would contradict the move.
  bool comes(double height, const std::function<bool(const Permit&)>& is_so) {
    poses.move_by({0.0, 0.0, height - 1.0});
    return test::eventually([&] {
      poses.send(0.0, false);
      return is_so(reader->newest());
    });
  }
  static bool is_relied_on(const Permit& permit) {
    return permit.error(client::monotonic_ns()) == ReportError::kGood;
  }
  bool has_told(const std::string& cause) {
    const std::lock_guard lock(mutex);
    return std::ranges::count(told, cause) > 0;
  }

  test::CellFile file{kCell};
  clearance::Cell cell = file.cell();
  clearance::DdsOptions dds = test::own_dds();
  clearance::Participant participant{dds};
  test::Poses poses{participant, cell};
  PermitOptions options{.stop_at = 0.2, .slow_from = 0.6};
  std::mutex mutex;
  std::vector<std::string> told;
  std::optional<PermitReader> reader;
  test::ChildProcess daemon{test::kDaemon, test::with({file.path()}, test::dds_arguments(dds))};
};

TEST_F(PermitReaderTest, ScalesBetweenTheTwoDistances) {
  read();
  const auto scaled = [](double scaling, Cause cause) {
    return [=](const Permit& permit) {
      return is_relied_on(permit) && std::abs(permit.scaling - scaling) < 1e-9 &&
             permit.cause == cause;
    };
  };
  EXPECT_TRUE(comes(1.0, scaled(1.0, Cause::kNone)));
  EXPECT_TRUE(comes(0.5, scaled(0.75, Cause::kDistance)));
  EXPECT_TRUE(comes(0.3, scaled(0.25, Cause::kDistance)));
  EXPECT_TRUE(comes(0.2 - 1e-6, scaled(0.0, Cause::kDistance)));
  EXPECT_TRUE(comes(-0.5, scaled(0.0, Cause::kDistance)));
  EXPECT_TRUE(comes(0.3, [this](const Permit&) { return has_told("a distance"); }));
  EXPECT_TRUE(comes(0.7, scaled(1.0, Cause::kNone)));
}

TEST_F(PermitReaderTest, CountsOnlyThePairsThatAreNamed) {
  options.pairs = {"floor - tool"};
  read();
  EXPECT_TRUE(comes(
      0.1, [](const Permit& permit) { return is_relied_on(permit) && permit.scaling == 1.0; }));
}

TEST_F(PermitReaderTest, HoldsWhileAZoneIsActive) {
  options = {.zones = {"low"}, .stream = options.stream};
  read();
  EXPECT_TRUE(comes(0.5, [](const Permit& permit) { return permit.scaling == 1.0; }));
  EXPECT_TRUE(comes(0.29, [](const Permit& permit) {
    return permit.scaling == 0.0 && permit.cause == Cause::kZone;
  }));
}

TEST_F(PermitReaderTest, HoldsWhatItCannotKnow) {
  options.pairs = {"hand - hook"};
  read();
  const auto is_unknown = [](const Permit& permit) {
    return is_relied_on(permit) && permit.scaling == 0.0 && permit.cause == Cause::kUnknown;
  };
  EXPECT_TRUE(comes(1.0, is_unknown));
  options = {.zones = {"high"}, .stream = options.stream};
  read();
  EXPECT_TRUE(comes(1.0, is_unknown));
}

// Reports go on, and their pairs are late or unknown.
TEST_F(PermitReaderTest, HoldsWithoutPoses) {
  read();
  ASSERT_TRUE(comes(1.0, [](const Permit& permit) { return permit.scaling == 1.0; }));
  EXPECT_TRUE(test::eventually([&] {
    const Permit& permit = reader->newest();
    return is_relied_on(permit) && permit.cause == Cause::kUnknown && permit.scaling == 0.0;
  }));
}

// A cell without separation and stops sends no scaling.
TEST_F(PermitReaderTest, HoldsIfAScalingIsMissing) {
  options.obeys_scaling = true;
  read();
  ASSERT_TRUE(comes(1.0, [](const Permit& permit) { return permit.scaling == 1.0; }));
  EXPECT_FALSE(is_relied_on(reader->newest()));
  EXPECT_TRUE(has_told("no report may be relied on: nothing heard"));
}

// The scaling would be that of another robot.
TEST(PermitsOfStops, HoldIfTheCellLacksAJointOfTheRobot) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  test::write_text(folder / "cell.yaml",
                   "name: stops\nunits: {length: m, angle: rad}\nrate_hz: 100\n"
                   "defaults: {age_limit_ms: 10000}\n"
                   "robots: [{name: arm, urdf: scara.urdf, joints: {elbow: {velocity: 2}}, "
                   "stopping: {reaction_ms: 40, time_ms: 200}}]\nobjects:\n"
                   "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [9, 0, 0]}}\n"
                   "pairs: [{between: [arm, pin], publish: true}]\n"
                   "zones: [{name: stands, between: [arm, pin], stops: {margin: 0.05}}]\n");
  const std::string file = (folder / "cell.yaml").string();
  const auto cell = std::get<clearance::Cell>(clearance::read_cell(file));
  const clearance::DdsOptions dds = test::own_dds();
  test::ChildProcess daemon(test::kDaemon, test::with({file}, test::dds_arguments(dds)));
  client::Connection connection(dds, cell.topics);
  client::JointWriter joints(connection, "driver",
                             std::vector<std::string>{"shoulder", "elbow", "push"});
  PermitOptions options{.obeys_scaling = true};
  options.stream.period = std::chrono::milliseconds(400);
  const auto comes = [&](const std::vector<std::string>& names, double scaling, Cause cause) {
    options.joints = names;
    PermitReader reader(dds, options, [](const std::string&) {});
    return test::eventually([&] {
      joints.write(std::vector{0.1, 0.2, 0.1}, std::vector{0.0, 0.0, 0.0});
      const Permit& permit = reader.newest();
      return permit.error(client::monotonic_ns()) == ReportError::kGood &&
             permit.scaling == scaling && permit.of_present == 1.0 && permit.cause == cause;
    });
  };
  EXPECT_TRUE(comes({"push", "shoulder"}, 1.0, Cause::kNone)) << daemon.output();
  EXPECT_TRUE(comes({"shoulder", "wrist"}, 0.0, Cause::kUnknown)) << daemon.output();
  EXPECT_TRUE(comes({"older", "push"}, 0.0, Cause::kUnknown)) << "one ends with it";
}

TEST_F(PermitReaderTest, HoldsAfterTheDaemonIsKilledAndUntilAnotherOneIsHeard) {
  read();
  const auto passes = [](const Permit& permit) {
    return is_relied_on(permit) && permit.scaling == 1.0;
  };
  ASSERT_TRUE(comes(1.0, passes));
  daemon.signal(SIGKILL);
  daemon.wait();
  const std::int64_t end_ns = client::monotonic_ns();
  ASSERT_TRUE(test::eventually([&] { return !is_relied_on(reader->newest()); }));
  // The last report came before the end, so after its lifetime none counts.
  EXPECT_FALSE(passes(reader->newest()));
  EXPECT_EQ(reader->newest().error(end_ns + options.stream.period.count() + 1),
            ReportError::kSilent);
  test::ChildProcess again(test::kDaemon, test::with({file.path()}, test::dds_arguments(dds)));
  EXPECT_TRUE(comes(1.0, passes));
}

TEST_F(PermitReaderTest, HoldsAfterTwoFaultyReportsUntilTheyAreAcknowledged) {
  read();
  ASSERT_TRUE(comes(1.0, [](const Permit& permit) { return permit.scaling == 1.0; }));
  const dds_entity_t writer =
      participant.writer(clearance::TopicKind::kDistances, cell.topics.distances);
  ASSERT_TRUE(test::eventually([&] { return test::matched_readers(writer) > 1; }));
  for (std::uint64_t cycle : {1u, 2u}) {
    clearance_msg_Distances without_checksum{};
    without_checksum.cycle = cycle;
    ASSERT_EQ(dds_write(writer, &without_checksum), DDS_RETCODE_OK);
  }
  const auto is_held = [](const Permit& permit) {
    return permit.cause_at(client::monotonic_ns()) == Cause::kHeld && !is_relied_on(permit);
  };
  EXPECT_TRUE(comes(1.0, is_held));
  reader->acknowledge();
  EXPECT_TRUE(comes(1.0, [&](const Permit& permit) { return is_relied_on(permit); }));
}

TEST_F(PermitReaderTest, RefusesOptionsThatLimitNothingOrContradictEachOther) {
  for (const PermitOptions& wrong :
       {PermitOptions{}, PermitOptions{.stop_at = 0.2},
        PermitOptions{.stop_at = 0.2, .slow_from = 0.1},
        PermitOptions{.pairs = {"hand - floor"}, .zones = {"low"}},
        PermitOptions{.stop_at = 0.1, .slow_from = 0.2, .pairs = {"hand and floor"}}}) {
    options = wrong;
    EXPECT_THROW(read(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace clearance_control
