// The log names what a hand carries and the cell does not know, with a command that attaches it.
//
// Oracle: the simulated machine carries a box that the daemon's cell does not have.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "tests/shared/ros_reader.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

// The shipped cell of an arm before a camera, which is a witness; `more`: objects.
std::string witnessed_arm(const std::string& more) {
  const std::string cells = places::sources() + "/config/cells/";
  std::string text = read_text(cells + "camera.yaml");
  const auto replace = [&](const std::string& before, const std::string& now) {
    for (std::size_t at = 0; (at = text.find(before, at)) != text.npos; at += now.size())
      text.replace(at, before.size(), now);
  };
  replace("seven_joint_arm/", cells + "seven_joint_arm/");
  replace("    depth_image:", "    witness: true\n    depth_image:");
  replace("objects:\n", "objects:\n" + more);
  return text;
}

// On a machine that builds meanwhile, few pictures come.
constexpr std::chrono::seconds kLimit(150);

TEST(DaemonPayload, IsNamedWithACommandUntilTheHandHasPutItDown) {
  const CellFile known(witnessed_arm("")),
      true_one(witnessed_arm("  - {name: crate, box: {size: [0.12, 0.12, 0.12]}, attached: {to: "
                             "hand, pose: {xyz: [0, 0, 0.2]}}}\n"));
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({known.path()}, dds_arguments(dds)));
  const auto simulated = [&](const CellFile& cell) {
    return with({cell.path(), "--swing", "0.3", "--camera-rate", "15", "--camera-size", "320x240"},
                dds_arguments(dds));
  };
  {
    ChildProcess carries(kRobot, simulated(true_one));
    ASSERT_TRUE(eventually(
        [&] {
          return daemon.told("carries-something",
                             {"camera", "'hand'", "clearance-scene send --change 'add_object",
                              "attach: {object: carried_by_hand, to: hand"});
        },
        kLimit))
        << daemon.output();
    EXPECT_FALSE(daemon.told("robot-not-there")) << daemon.output();
  }
  ChildProcess empty(kRobot, simulated(known));
  EXPECT_TRUE(eventually(
      [&] {
        return daemon.told("carries-nothing", {"camera", "'hand'"});
      },
      kLimit))
      << daemon.output();
}

}  // namespace
}  // namespace clearance::test
