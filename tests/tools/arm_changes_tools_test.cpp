// The example of an arm with a tool changer, over DDS.
//
// Oracle: the example compares every bound with the distance at the places that it has sent.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/shared/places.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

TEST(ToolChangingArm, ChangesItsToolsAndNoBoundIsFalse) {
  const std::string cell = places::sources() + "/config/cells/tools.yaml";
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({cell}, dds_arguments(dds)));
  ChildProcess arm(places::programs() + "/example_arm",
                   with({"tools", cell, "--changes", "20"}, dds_arguments(dds)));
  ASSERT_EQ(arm.wait(std::chrono::seconds(180)), 0) << arm.output();
  std::istringstream lines(arm.output());
  std::string head, row;
  std::getline(lines, head);
  std::getline(lines, row);
  std::istringstream figures(row);
  // How many reports were missed or unknown depends on how busy the machine is.
  std::uint64_t changes = 0, reports = 0, missed = 0, unknown = 0, compared = 0, wrong = 1;
  figures >> changes >> reports >> missed >> unknown >> compared >> wrong;
  EXPECT_EQ(changes, 20u) << arm.output();
  EXPECT_GT(compared, 1000u) << arm.output();
  EXPECT_EQ(wrong, 0u) << arm.output();
}

}  // namespace
}  // namespace clearance::test
