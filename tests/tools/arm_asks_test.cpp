// The example of an operator whose jogs are asked about, over DDS with the daemon.
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

TEST(JoggingArm, IsRefusedAndSlowedWithTheReasonAndNeverComesNearerThanItAskedFor) {
  const std::string cell = test::places::sources() + "/config/cells/pick.yaml";
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({cell, "--questions", "example arm"}, dds_arguments(dds)));
  ChildProcess arm(test::places::programs() + "/example_arm",
                   with({"ask", cell, "--speed", "2"}, dds_arguments(dds)));
  ASSERT_EQ(arm.wait(std::chrono::seconds(180)), 0) << arm.output();
  const std::string output = arm.output();
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      output, found,
      std::regex(R"((\d+) jogs made, (\d+) slowed, (\d+) refused;.* at least ([0-9.]+) m)")))
      << output;
  EXPECT_GT(std::stoi(found[1]), 0) << output;
  EXPECT_GT(std::stoi(found[2]), 0) << output;
  EXPECT_GT(std::stoi(found[3]), 0) << output;
  EXPECT_GE(std::stod(found[4]), 0.005 - 1e-4) << output;
  // The arm itself would come too near after 0.29 s. Told to stop, it may do so sooner.
  EXPECT_TRUE(std::regex_search(output, std::regex("refused.*wall.* from 0.2[0-5] s on")))
      << output;
}

}  // namespace
}  // namespace clearance::test
