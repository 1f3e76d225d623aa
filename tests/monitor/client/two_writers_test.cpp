// Two partners that both publish a cycle, with different content, as a merging client hears them
// over real DDS. The test plays both.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::client {
namespace {

constexpr std::chrono::milliseconds kWaiting(20'000);

class TwoWriters : public testing::Test {
 protected:
  struct Writer {
    std::string name;
    Participant participant;
    dds_entity_t distances = participant.writer(TopicKind::kDistances, Topics{}.distances);
    explicit Writer(std::string as, const DdsOptions& dds)
        : name(std::move(as)), participant(dds) {}

    void report(std::uint64_t cycle, double lower, std::uint64_t lineage = 1) const {
      clearance_msg_Distances message{};
      name.copy(message.partner, sizeof message.partner - 1);
      message.daemon = static_cast<std::uint64_t>(name[0]);
      message.cycle = cycle;
      message.lineage = lineage;
      message.now_ns = static_cast<std::int64_t>(cycle) * 1'000'000;
      message.publish_ns = dds_time();
      message.lower_all = lower;
      seal(message, participant.address(Topics{}.distances));
      ASSERT_EQ(dds_write(distances, &message), DDS_RETCODE_OK);
    }
  };
  void SetUp() override {
    for (const Writer* writer : {&left, &right})
      ASSERT_TRUE(test::eventually([&] { return test::matched_readers(writer->distances) > 0; }));
  }
  // Both report this cycle, the first of the two before the other one. Returns what the client is
  // handed out until it has heard both.
  std::vector<double> handed_out(std::uint64_t cycle, double of_left, double of_right,
                                 std::uint64_t lineage_of_right = 1) {
    const bool left_first = cycle % 2 == 0;
    if (left_first) left.report(cycle, of_left);
    right.report(cycle, of_right, lineage_of_right);
    if (!left_first) left.report(cycle, of_left);
    std::vector<double> bounds;
    if (reports.next(kWaiting)) bounds.push_back(reports->lower_all);
    while (reports.next(std::chrono::milliseconds(50))) bounds.push_back(reports->lower_all);
    return bounds;
  }

  DdsOptions dds = test::own_dds();
  Connection connection{dds};
  Reports reports{connection};
  Writer left{"left", dds}, right{"right", dds};
};

// The same inputs: one of the two machines is faulty, and the client cannot know which.
TEST_F(TwoWriters, OfOneCycleWithDifferentBitsAreToldWithTheNextCycleAndOneReportIsHandedOut) {
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle)
    ASSERT_EQ(handed_out(cycle, 0.5, 0.5), std::vector{0.5}) << cycle;
  ASSERT_EQ(reports.partner().state, PartnerState::kAgrees);
  for (std::uint64_t cycle = 4; cycle <= 9; ++cycle) {
    const auto bounds = handed_out(cycle, 0.5, 0.4);
    ASSERT_EQ(bounds.size(), 1u) << cycle;
    EXPECT_TRUE(bounds[0] == 0.5 || bounds[0] == 0.4);
    EXPECT_EQ(reports->cycle, cycle);
    EXPECT_EQ(reports.check().missed, 0u);
    EXPECT_FALSE(reports.check().other_daemon);
    if (cycle == 4) continue;
    EXPECT_EQ(reports.partner().state, PartnerState::kDifferent) << cycle;
    EXPECT_EQ(reports.partner().cycle, cycle - 1);
  }
  ASSERT_EQ(handed_out(10, 0.5, 0.5), std::vector{0.5});
  EXPECT_EQ(reports.partner().state, PartnerState::kDifferent);
  ASSERT_EQ(handed_out(11, 0.5, 0.5), std::vector{0.5});
  EXPECT_EQ(reports.partner().state, PartnerState::kAgrees);
}

// Both believe that they lead, as after a cut link: each has a lineage of its own.
TEST_F(TwoWriters, ThatBothLeadAreToldAsOtherInputsAndOneReportIsHandedOut) {
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle)
    ASSERT_EQ(handed_out(cycle, 0.5, 0.5), std::vector{0.5}) << cycle;
  for (std::uint64_t cycle = 4; cycle <= 9; ++cycle) {
    const auto bounds = handed_out(cycle, 0.5, 0.4, 2);
    ASSERT_EQ(bounds.size(), 1u) << cycle;
    EXPECT_EQ(reports->cycle, cycle);
    EXPECT_EQ(reports.check().missed, 0u);
    if (cycle == 4) continue;
    EXPECT_EQ(reports.partner().state, PartnerState::kOtherInputs) << cycle;
    EXPECT_EQ(reports.partner().cycle, cycle - 1);
  }
}

}  // namespace
}  // namespace clearance::client
