// Two recordings of partners: only ticks of the same lineage are compared, and those that were left
// out are counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "monitor/replay/recordings_difference.hpp"
#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using Kind = RecordingsDifference::Kind;
using Messages = std::vector<Kept>;
using LeftOut = std::array<std::uint64_t, 2>;

constexpr std::uint64_t kBoth = 7, kAfter = 8, kAlone = 9;  // lineages

std::uint64_t cycle_at(std::int64_t now_ns) {
  return static_cast<std::uint64_t>((now_ns - kStart) / kTick) + 1;
}

// Both recordings are of one run. A test changes the second one as a partner's would differ.
class RecordingsOfPartners : public OfflineReplayTest {
 protected:
  RecordingsOfPartners() {
    record_run(cell, run);
    left = right = messages_of(run);
    for (Messages* const messages : {&left, &right}) set_lineage(*messages, kBoth, 1, 200);
  }
  // Changes the reports of these cycles.
  template <class Change>
  static void change_reports(Messages& messages, std::uint64_t first, std::uint64_t last,
                             const Change& change) {
    for (Kept& message : messages) {
      if (message.kind != TopicKind::kDistances) continue;
      const std::uint64_t cycle = decoded<clearance_msg_Distances>(message)->cycle;
      if (cycle >= first && cycle <= last)
        message = altered<clearance_msg_Distances>(message, change);
    }
  }
  static void set_lineage(Messages& messages, std::uint64_t lineage, std::uint64_t first,
                          std::uint64_t last) {
    change_reports(messages, first, last,
                   [lineage](clearance_msg_Distances& report) { report.lineage = lineage; });
  }
  // The partner was started `alone` ticks before it joined in this cycle, and counted from `number`
  // on by itself, with results of its own.
  static void join(Messages& messages, std::uint64_t joined, std::uint64_t alone,
                   std::uint64_t number) {
    const std::uint64_t began = joined - alone;
    const auto is_before = [](std::uint64_t cycle, std::uint64_t limit) { return cycle < limit; };
    std::erase_if(messages, [&](const Kept& message) {
      return message.kind == TopicKind::kDistances &&
             is_before(decoded<clearance_msg_Distances>(message)->cycle, began);
    });
    for (Kept& message : messages) {
      if (message.kind == TopicKind::kZones) {
        message = altered<clearance_msg_ZoneState>(message, [&](clearance_msg_ZoneState& state) {
          if (is_before(state.cycle, joined)) {
            state.now_ns = kStart + static_cast<std::int64_t>(began - 1) * kTick;
            state.cycle = number;
          }
        });
      }
    }
    change_reports(messages, began, joined - 1, [&](clearance_msg_Distances& report) {
      report.lineage = kAlone;
      report.cycle = number + cycle_at(report.now_ns) - began;
      report.minimum.distance += 0.5;
    });
  }
  RecordingsDifference compare() {
    write_messages(run, left);
    write_messages(folder / "right.mcap", right);
    return compare_recordings(run, folder / "right.mcap");
  }
  Messages left, right;
};

TEST_F(RecordingsOfPartners, AreComparedFromTheCycleInWhichOneJoined) {
  join(right, 50, 30, 1);
  const RecordingsDifference found = compare();
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  EXPECT_EQ(found.first_cycle, 50u);
  EXPECT_EQ(found.last_cycle, 200u);
  EXPECT_EQ(found.compared, 151u);
  EXPECT_EQ(found.stretches.size(), 1u);
  EXPECT_EQ(found.left_out, (LeftOut{49, 30}));
}

TEST_F(RecordingsOfPartners, MayHoldCyclesAgainThatThePartnerHadCountedAlone) {
  join(right, 50, 30, 40);
  const RecordingsDifference found = compare();
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  EXPECT_EQ(found.first_cycle, 50u);
  EXPECT_EQ(found.compared, 151u);
  EXPECT_EQ(found.left_out, (LeftOut{49, 30}));
}

TEST_F(RecordingsOfPartners, ThatPartAndMeetAgainAgreeInTwoStretches) {
  set_lineage(right, kAlone, 80, 99);
  change_reports(right, 80, 99, [](clearance_msg_Distances& report) {
    report.now_ns += 30'000;
    ++report.queries;
  });
  for (Messages* const messages : {&left, &right}) set_lineage(*messages, kAfter, 100, 200);
  const RecordingsDifference found = compare();
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  ASSERT_EQ(found.stretches.size(), 2u);
  EXPECT_EQ(found.stretches[0].first, 1u);
  EXPECT_EQ(found.stretches[0].last, 79u);
  EXPECT_EQ(found.stretches[1].first, 100u);
  EXPECT_EQ(found.stretches[1].last, 200u);
  EXPECT_EQ(found.left_out, (LeftOut{20, 20}));
}

TEST_F(RecordingsOfPartners, DoNotPartWhereBothBeginALineageInTheSameCycle) {
  for (Messages* const messages : {&left, &right}) set_lineage(*messages, kAfter, 100, 200);
  const RecordingsDifference found = compare();
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  EXPECT_EQ(found.compared, 200u);
  EXPECT_EQ(found.stretches.size(), 1u);
}

TEST_F(RecordingsOfPartners, AnotherBitAfterTheJoinIsADifferenceOfResults) {
  join(right, 50, 30, 1);
  change_reports(right, 73, 73, [](clearance_msg_Distances& report) {
    double& y = report.pairs._buffer[0].witness_a.y;
    y = std::nextafter(y, 9.0);
  });
  const RecordingsDifference found = compare();
  EXPECT_EQ(found.kind, Kind::kResult) << found.error << found.what;
  EXPECT_EQ(found.cycle, 73u);
  EXPECT_THAT(found.what, HasSubstr("witness_a.y"));
  EXPECT_THAT(found.what, testing::Not(HasSubstr("may be the reason")))
      << "of one lineage means the same history";
}

TEST_F(RecordingsOfPartners, ATimeThatDiffersWithinALineageIsFound) {
  change_reports(right, 73, 73, [](clearance_msg_Distances& report) { report.now_ns += 40'000; });
  const RecordingsDifference found = compare();
  EXPECT_EQ(found.kind, Kind::kTime) << found.error << found.what;
  EXPECT_EQ(found.cycle, 73u);
}

TEST_F(RecordingsOfPartners, AReportThatOneLacksWithinALineageIsMissing) {
  join(right, 50, 30, 1);
  std::erase_if(right, [](const Kept& message) {
    return message.kind == TopicKind::kDistances &&
           decoded<clearance_msg_Distances>(message)->cycle == 90;
  });
  const RecordingsDifference found = compare();
  EXPECT_EQ(found.kind, Kind::kMissing) << found.error << found.what;
  EXPECT_EQ(found.cycle, 90u);
}

TEST_F(RecordingsOfPartners, MayNumberASourceApart) {
  change_reports(right, 1, 200, [](clearance_msg_Distances& report) {
    for (std::uint32_t i = 0; i < report.sources._length; ++i)
      report.sources._buffer[i].sequence_number += 1000;
  });
  const RecordingsDifference found = compare();
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  change_reports(right, 60, 60, [](clearance_msg_Distances& report) { ++report.queries; });
  const RecordingsDifference other = compare();
  EXPECT_EQ(other.kind, Kind::kResult) << other.error << other.what;
  EXPECT_THAT(other.what, HasSubstr("apart, so their content was not compared"));
}

// One that was apart has used the batch already, in a tick of its own.
TEST_F(RecordingsOfPartners, MayHoldABatchOfTheFirstCommonTickEarlier) {
  const auto number = [&](std::size_t place) -> std::uint64_t {
    const auto report = decoded<clearance_msg_Distances>(left[place]);
    for (std::uint32_t i = 0; i < report->sources._length; ++i) {
      if (report->sources._buffer[i].source == std::string("arm"))
        return report->sources._buffer[i].sequence_number;
    }
    return 0;
  };
  int joined = 50;  // a tick that uses batches of the arm, as the one before does
  while (number(report_of(left, joined)) == 0 || number(report_of(left, joined - 1)) == 0) ++joined;
  const std::uint64_t used = number(report_of(left, joined));
  const auto cycle = static_cast<std::uint64_t>(joined);
  change_reports(right, cycle - 1, cycle - 1, [used](clearance_msg_Distances& report) {
    for (std::uint32_t i = 0; i < report.sources._length; ++i) {
      if (report.sources._buffer[i].source == std::string("arm"))
        report.sources._buffer[i].sequence_number = used;
    }
  });
  join(right, cycle, 30, 1);
  const RecordingsDifference found = compare();
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  EXPECT_EQ(found.first_cycle, cycle);
}

TEST_F(RecordingsOfPartners, BatchesOfAnotherContentAreADifferenceOfInputs) {
  for (Kept& message : right) {
    if (message.kind != TopicKind::kPoses ||
        decoded<clearance_msg_PoseBatch>(message)->sequence_number != 20)
      continue;
    message = altered<clearance_msg_PoseBatch>(message, [](clearance_msg_PoseBatch& batch) {
      batch.poses._buffer[0].position.x += 1e-12;
    });
  }
  const RecordingsDifference found = compare();
  EXPECT_EQ(found.kind, Kind::kInputs) << found.error << found.what;
  EXPECT_TRUE(found.what.starts_with("batch 20 of source '")) << found.what;
}

TEST_F(RecordingsOfPartners, ThatNeverJoinedHaveNothingInCommon) {
  set_lineage(right, kAlone, 1, 200);
  const RecordingsDifference found = compare();
  EXPECT_FALSE(found.is_same());
  EXPECT_THAT(found.error, HasSubstr("never ticked the same inputs"));
}

}  // namespace
}  // namespace clearance::test
