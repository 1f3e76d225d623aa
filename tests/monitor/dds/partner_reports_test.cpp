// A daemon counts and logs what its partner's reports say.
#include "monitor/dds/partner_reports.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

#include "tests/shared/logged.hpp"

namespace clearance::test {
namespace {

constexpr std::uint64_t kLineage = 5;
constexpr std::int64_t kPeriod = 1'000'000;

clearance_msg_Distances report(const char* partner, std::uint64_t cycle,
                               std::uint64_t lineage = kLineage) {
  clearance_msg_Distances message{};
  std::strcpy(message.partner, partner);
  message.cycle = cycle;
  message.lineage = lineage;
  message.checksum = 1000 + cycle;
  message.state_checksum = 2000 + cycle;
  message.publish_ns = static_cast<std::int64_t>(cycle) * kPeriod;
  return message;
}

class PartnerReportsTest : public testing::Test {
 protected:
  void own(std::uint64_t cycle, std::uint64_t lineage = kLineage) {
    reports_.note_own(report("left", cycle, lineage));
  }
  void other(std::uint64_t cycle, std::uint64_t lineage = kLineage) {
    reports_.note_other(report("right", cycle, lineage));
  }
  // Both report these cycles alike.
  void agree(std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t cycle = first; cycle <= last; ++cycle) {
      own(cycle);
      other(cycle);
    }
  }
  [[nodiscard]] clearance_msg_PartnerHealth health() {
    clearance_msg_PartnerHealth health{};
    reports_.fill(health);
    return health;
  }
  [[nodiscard]] std::size_t lines(const std::string& code) const {
    return logged_->count("[" + code + "]");
  }

  PartnerReports reports_;
  std::shared_ptr<Logged> logged_ = std::make_shared<Logged>();
  LoggedTo to_{logged_};
};

TEST_F(PartnerReportsTest, OfADaemonAloneAreNeitherComparedNorMissed) {
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) own(cycle);
  EXPECT_FALSE(reports_.hears_any());
  const clearance_msg_PartnerHealth found = health();
  EXPECT_STREQ(found.other, "");
  EXPECT_FALSE(found.other_publishes);
  EXPECT_EQ(found.compared + found.different + found.other_inputs + found.missing, 0u);
  EXPECT_EQ(found.agrees_from, 0u);
  EXPECT_EQ(logged_->text(), "");
}

TEST_F(PartnerReportsTest, OfTheSameBitsAgreeWhicheverComesFirst) {
  agree(7, 8);
  other(9);
  own(9);
  const clearance_msg_PartnerHealth found = health();
  EXPECT_STREQ(found.other, "right");
  EXPECT_TRUE(found.other_publishes);
  EXPECT_EQ(found.agrees_from, 7u);
  EXPECT_EQ(found.compared, 3u);
  EXPECT_EQ(found.different + found.other_inputs + found.missing, 0u);
  EXPECT_EQ(lines("partner-agrees"), 1u);
  EXPECT_TRUE(logged_->has("'right' agrees from cycle 7")) << logged_->text();
}

TEST_F(PartnerReportsTest, WithOtherBitsForTheSameInputsAreCountedAndLoggedAsAFault) {
  agree(1, 5);
  own(6);
  auto flipped = report("right", 6);
  flipped.checksum ^= 4;
  reports_.note_other(flipped);
  EXPECT_EQ(health().different, 1u);
  EXPECT_EQ(health().agrees_from, 0u);
  EXPECT_TRUE(logged_->has("[partner-differs]")) << logged_->text();
  EXPECT_TRUE(logged_->has("'right' reports other bits for cycle 6")) << logged_->text();
  agree(7, 7);
  EXPECT_EQ(health().agrees_from, 7u) << "they agree again";
}

TEST_F(PartnerReportsTest, WithAnotherStateDifferEvenIfTheReportIsTheSame) {
  own(1);
  auto flipped = report("right", 1);
  flipped.state_checksum ^= 1;
  reports_.note_other(flipped);
  EXPECT_EQ(health().compared, 1u);
  EXPECT_EQ(health().different, 1u);
  EXPECT_EQ(lines("partner-differs"), 1u);
}

TEST_F(PartnerReportsTest, ThatDifferAllTheTimeAreLoggedOnceASecondAndAllCounted) {
  const auto began = std::chrono::steady_clock::now();
  for (std::uint64_t cycle = 1; cycle <= 500; ++cycle) {
    own(cycle);
    auto flipped = report("right", cycle);
    flipped.checksum ^= 1;
    reports_.note_other(flipped);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  EXPECT_EQ(health().different, 500u);
  EXPECT_GE(lines("partner-differs"), 1u);
  EXPECT_LE(static_cast<double>(lines("partner-differs")), 1.0 + took.count());
}

TEST_F(PartnerReportsTest, OfAnotherLineageAreOtherInputsAndNoFault) {
  agree(1, 5);
  for (std::uint64_t cycle = 6; cycle <= 8; ++cycle) {
    own(cycle);
    other(cycle, kLineage + 1);
  }
  const clearance_msg_PartnerHealth found = health();
  EXPECT_EQ(found.other_inputs, 3u);
  EXPECT_EQ(found.compared, 5u);
  EXPECT_EQ(found.different, 0u);
  EXPECT_EQ(found.agrees_from, 0u);
  EXPECT_EQ(lines("partner-other-inputs"), 1u);
  EXPECT_TRUE(logged_->has("'right' ticked cycle 6 with other inputs")) << logged_->text();
  EXPECT_EQ(lines("partner-differs"), 0u);
}

// A partner that never agreed has just been started.
TEST_F(PartnerReportsTest, OfAnotherLineageBeforeTheFirstAgreementAreNotLogged) {
  own(1);
  other(1, kLineage + 1);
  EXPECT_EQ(health().other_inputs, 1u);
  EXPECT_EQ(lines("partner-other-inputs"), 0u);
}

TEST_F(PartnerReportsTest, ThatDoNotComeAreMissedTwoCyclesLater) {
  agree(1, 5);
  own(6);
  own(7);
  EXPECT_EQ(health().missing, 0u) << "it may still come";
  own(8);
  EXPECT_EQ(health().missing, 1u);
  EXPECT_TRUE(logged_->has("[partner-missing]"));
  EXPECT_TRUE(logged_->has("'right' has not reported cycle 6 in time")) << logged_->text();
}

TEST_F(PartnerReportsTest, OfAPartnerThatIsGoneAreMissedOnlyOnce) {
  agree(1, 5);
  EXPECT_TRUE(reports_.hears_any());
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  EXPECT_FALSE(reports_.hears_any());
  for (std::uint64_t cycle = 6; cycle <= 20; ++cycle) own(cycle);
  const clearance_msg_PartnerHealth found = health();
  EXPECT_EQ(found.missing, 1u);
  EXPECT_EQ(found.agrees_from, 0u) << "it has ended";
  EXPECT_EQ(lines("partner-missing"), 1u);
}

// One that has stood still may yet write what it had begun to write.
TEST_F(PartnerReportsTest, OfAPartnerThatIsSilentDoNotAgree) {
  EXPECT_FALSE(reports_.disagrees()) << "there is none";
  agree(1, 5);
  EXPECT_FALSE(reports_.disagrees());
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  for (std::uint64_t cycle = 6; cycle <= 20; ++cycle) own(cycle);
  EXPECT_TRUE(reports_.disagrees());
}

TEST_F(PartnerReportsTest, WithOtherNumbersOfInputsDifferAsForClients) {
  auto mine = report("left", 1), yours = report("right", 1);
  clearance_msg_SourceUse use[2] = {{"arm", 7}, {"arm", 8}};
  mine.sources._buffer = &use[0];
  yours.sources._buffer = &use[1];
  mine.sources._length = yours.sources._length = 1;
  reports_.note_own(mine);
  reports_.note_other(yours);
  EXPECT_EQ(health().different, 1u);
}

TEST_F(PartnerReportsTest, ThatComeLongAfterwardsAreNotComparedWithOthers) {
  for (std::uint64_t cycle = 1; cycle <= 300; ++cycle) own(cycle);
  other(44);
  EXPECT_EQ(health().compared, 0u);
  EXPECT_EQ(health().other_inputs, 0u);
}

TEST_F(PartnerReportsTest, ShowAThirdPartnerByItsName) {
  other(1);
  EXPECT_FALSE(reports_.hears_another("right"));
  EXPECT_TRUE(reports_.hears_another("third"));
}

TEST_F(PartnerReportsTest, StateTheMiddleOfThePhasesSinceTheLastHealth) {
  const std::int64_t later_ns[] = {20, -900, 30};
  for (std::uint64_t cycle = 1; cycle <= 3; ++cycle) {
    other(cycle);
    auto mine = report("left", cycle);
    mine.publish_ns += later_ns[cycle - 1];
    reports_.note_own(mine);
  }
  EXPECT_EQ(health().phase_ns, 20);
  EXPECT_EQ(health().phase_ns, 20) << "none came since";
}

}  // namespace
}  // namespace clearance::test
