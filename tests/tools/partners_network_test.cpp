// Two daemons that are partners on two machines, and a link between them that is cut.
#include <gtest/gtest.h>

#include <csignal>
#include <optional>
#include <string>

#include "tests/tools/lossy_network.hpp"
#include "tests/tools/meeting_boxes.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;
using test::kDaemon;

// A link that is cut leaves a leader in each half. Of the two, one follows when it is whole again.
TEST(PartnersOnANetwork, BothHalvesOfACutGoOnAndAgreeAfterwards) {
  test::NetworkNamespace one(1), other(2);
  for (const auto* machine : {&one, &other}) {
    if (!machine->refusal().empty()) GTEST_SKIP() << machine->refusal();
  }
  test::LossyWire wire(one.frames(), other.frames());
  const test::CellFile file(test::meeting_cell());
  const Cell cell = file.cell();
  DdsOptions dds = test::own_dds();
  const auto arguments = test::with(test::with({file.path()}, test::dds_arguments(dds)),
                                    {"--interface", "eth0", "--partner"});
  dds.interface = "eth0";
  std::optional<ChildProcess> left, right;
  std::optional<test::SendingRobot> robot;
  one.run([&] {
    robot.emplace(dds, cell);
    left.emplace(kDaemon, test::with(arguments, {"left"}));
  });
  ASSERT_TRUE(eventually([&] { return left->told("partner-stands", {"leading"}); }));
  other.run([&] { right.emplace(kDaemon, test::with(arguments, {"right"})); });
  const auto agreements = [](const ChildProcess& daemon) {
    const std::string text = daemon.output();
    int count = 0;
    for (std::size_t at = 0; (at = text.find("[partner-agrees]", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  ASSERT_TRUE(eventually([&] { return agreements(*left) > 0 && agreements(*right) > 0; }))
      << left->output() << right->output();
  wire.lose(1.0);
  ASSERT_TRUE(eventually([&] { return right->told("partner-stands", {"leading"}); }))
      << right->output();
  const int before = agreements(*right);
  wire.lose(0.0);
  EXPECT_TRUE(eventually([&] { return agreements(*right) > before; }))
      << left->output() << right->output();
  for (auto* daemon : {&*left, &*right}) {
    daemon->signal(SIGTERM);
    EXPECT_EQ(daemon->wait(), 0) << daemon->output();
    EXPECT_FALSE(daemon->told("partner-differs")) << daemon->output();
  }
  one.run([&] { robot.reset(); });
}

}  // namespace
}  // namespace clearance
