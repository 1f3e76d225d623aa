// A daemon tells what is wrong with its partner: the rows of FAULTS.md about partners that two
// daemons on one machine do not come to by themselves.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "monitor/client/client.hpp"
#include "tests/tools/made_partner.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using std::chrono::milliseconds;

class PartnerFaults : public testing::Test {
 protected:
  DdsOptions dds = own_dds();
  CellFile file{small_cell("pair")};
  Cell cell = file.cell();
  MadePartner partner{dds, cell};
  ChildProcess daemon{
      kDaemon, with(with({file.path()}, dds_arguments(dds)), {"--partner", "left", "--gradients"})};

  // Until the daemon tells of it, the partner does this again and again.
  template <class Do>
  bool tells(const std::string& code, const std::vector<std::string>& names, const Do& act) {
    return eventually([&] {
      for (int i = 0; i < 10; ++i) {
        act();
        std::this_thread::sleep_for(milliseconds(2));
      }
      return daemon.told(code, names);
    });
  }
};

TEST_F(PartnerFaults, AClockThatIsBehindIsNamedWithItsDifference) {
  EXPECT_TRUE(tells("partner-clock", {"right"}, [&] { partner.lead(60'000'000); }))
      << daemon.output();
}

TEST_F(PartnerFaults, ClocksInStepAreNotNamed) {
  for (int i = 0; i < 800; ++i) {
    partner.lead();
    std::this_thread::sleep_for(milliseconds(2));
  }
  EXPECT_FALSE(daemon.told("partner-clock")) << daemon.output();
}

TEST_F(PartnerFaults, ANoticeOfATickThatIsDueHoursLaterIsNamedAndLeadsNobody) {
  EXPECT_TRUE(tells("partner-notice-refused", {"no leader can have"}, [&] {
    partner.lead(0, true, std::int64_t{1} << 43);
  })) << daemon.output();
  EXPECT_FALSE(daemon.told("partner-stands", {"apart"})) << daemon.output();
}

TEST_F(PartnerFaults, AnotherBuildIsNamed) {
  EXPECT_TRUE(tells("partner-other-build", {"right", "0.0 of another day"}, [&] {
    partner.send({.build = "0.0 of another day"});
  })) << daemon.output();
}

TEST_F(PartnerFaults, AStateOfAnotherSceneIsRefused) {
  EXPECT_TRUE(tells("partner-state-refused", {"another scene"}, [&] {
    partner.lead();
    partner.send({.revisions_later = 1});
  })) << daemon.output();
}

TEST_F(PartnerFaults, AStateWhoseBytesDoNotFitIsRefused) {
  EXPECT_TRUE(tells("partner-state-refused", {"do not fit"}, [&] {
    partner.lead();
    partner.send({});
  })) << daemon.output();
}

// While the other one is heard, a simple reader gets nothing, although the daemon leads the ticks.
// The half second begins again after the test or the daemon was held up: no leader was heard then.
TEST_F(PartnerFaults, ALeaderIsSilentForSimpleReadersWhileAnotherOneLeads) {
  Participant client(dds);
  const dds_entity_t reader = client.reader(TopicKind::kGradients, cell.topics.gradients, 1024);
  // The number of samples that were written from this time on.
  const auto written_since = [&](std::int64_t since_ns) {
    Sample<clearance_msg_Gradients> sample;
    void* pointer = &*sample;
    dds_sample_info_t info;
    int count = 0;
    while (dds_take(reader, &pointer, &info, 1, 1) > 0)
      count += info.valid_data && info.source_timestamp > since_ns;
    return count;
  };
  ASSERT_TRUE(eventually([&] { return written_since(0) > 0; })) << daemon.output();
  std::int64_t since_ns = dds_time(), last_ns = since_ns;
  ASSERT_TRUE(eventually([&] {
    const std::int64_t now_ns = dds_time();
    const bool was_held_up = now_ns - last_ns > leader_lease_ns(0) / 2;
    last_ns = now_ns;
    partner.lead(0, false);
    if (was_held_up || written_since(since_ns + 100'000'000) > 0) since_ns = now_ns;
    return now_ns - since_ns > 500'000'000;
  })) << daemon.output();
  EXPECT_TRUE(eventually([&] { return written_since(last_ns) > 0; })) << daemon.output();
  EXPECT_FALSE(daemon.told("partner-stands", {"apart"})) << daemon.output();
}

// The partner says again what the daemon reports, then changes a number, then its lineage, and
// then it falls silent. Log and health name each of these.
TEST_F(PartnerFaults, ReportsOfOtherBitsOfOtherInputsAndMissingOnesAreNamedAndCounted) {
  Participant client(dds);
  Distances reports(client, cell);
  client::Connection connection(dds, cell.topics);
  client::Health health(connection);
  // Many at a time: the reader has the partner's own reports, too, and must not fall behind.
  const auto repeats = [&](const auto& change) {
    for (int i = 0; i < 20; ++i) {
      const auto report = reports.next();
      if (report != nullptr && (*report)->partner == std::string("left"))
        partner.report(**report, change);
    }
  };
  const auto counted = [&](const auto& count) {
    return eventually([&] {
      health.update();
      return health.message() != nullptr && count(health.message()->partner) > 0;
    });
  };
  EXPECT_TRUE(tells("partner-agrees", {"right"}, [&] { repeats([](auto&) {}); }))
      << daemon.output();
  EXPECT_FALSE(daemon.told("partner-differs")) << daemon.output();
  EXPECT_TRUE(tells("partner-differs", {"right"}, [&] {
    repeats([](auto& report) { ++report.queries; });
  })) << daemon.output();
  EXPECT_TRUE(counted([](const auto& partners) { return partners.different; }));
  EXPECT_TRUE(tells("partner-other-inputs", {"right"}, [&] {
    repeats([](auto&) {});
    repeats([](auto& report) { ++report.lineage; });
  })) << daemon.output();
  EXPECT_TRUE(counted([](const auto& partners) { return partners.other_inputs; }));
  const auto falls_silent = [&] {
    repeats([](auto&) {});
    std::this_thread::sleep_for(milliseconds(100));
  };
  EXPECT_TRUE(tells("partner-missing", {"right"}, falls_silent)) << daemon.output();
  EXPECT_TRUE(counted([](const auto& partners) { return partners.missing; }));
  EXPECT_TRUE(daemon.running()) << daemon.output();
}

}  // namespace
}  // namespace clearance::test
