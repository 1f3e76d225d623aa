// Two recordings of the same cycles: the first difference is found, and told as one of the inputs,
// of the ticks' times or of the results.
#include "monitor/replay/recordings_difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/monitor/replay/offline_replay_run.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using Kind = RecordingsDifference::Kind;

class TwoRecordings : public OfflineReplayTest {
 protected:
  TwoRecordings() : other(run.parent_path() / "other.mcap") {}
  // The other recording is the first one with a change.
  template <class Change>
  RecordingsDifference after(const Change& change) {
    record_run(cell, run);
    std::vector<Kept> messages = messages_of(run);
    change(messages);
    write_messages(other, messages, outline(run).build);
    return compare_recordings(run, other);
  }
  template <class T, class Change>
  static void alter(Kept& message, const Change& change) {
    message = altered<T>(message, change);
  }
  static std::size_t batch_before(const std::vector<Kept>& messages, std::size_t report) {
    while (messages[report].kind != TopicKind::kPoses) --report;
    return report;
  }
  std::filesystem::path other;
};

TEST_F(TwoRecordings, OfTheSameTicksDoNotDiffer) {
  const RecordingsDifference found = after([](std::vector<Kept>&) {});
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  EXPECT_EQ(200u, found.compared);
  EXPECT_EQ(1u, found.first_cycle);
  EXPECT_EQ(200u, found.last_cycle);
}

TEST_F(TwoRecordings, ALastBitOfAReportIsADifferenceOfResults) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    for (const int tick : {58, 60}) {
      alter<clearance_msg_Distances>(messages[report_of(messages, tick)],
                                     [](clearance_msg_Distances& report) {
                                       double& y = report.pairs._buffer[1].witness_a.y;
                                       y = std::nextafter(y, 9.0);
                                     });
    }
  });
  EXPECT_EQ(Kind::kResult, found.kind);
  EXPECT_EQ(58u, found.cycle);
  EXPECT_EQ(kStart + 57 * kTick, found.now_ns);
  EXPECT_THAT(found.what, HasSubstr("pairs[1] (hand - box).witness_a.y"));
  EXPECT_THAT(found.what, HasSubstr("other.mcap"));
}

TEST_F(TwoRecordings, ABatchThatOneDaemonLackedIsADifferenceOfInputsAlsoWhereResultsFollow) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    alter<clearance_msg_Distances>(messages[report_of(messages, 31)],
                                   [](clearance_msg_Distances& report) {
                                     ASSERT_GT(report.sources._length, 0u);
                                     --report.sources._buffer[0].sequence_number;
                                     report.minimum.distance += 1e-9;
                                   });
  });
  EXPECT_EQ(Kind::kInputs, found.kind);
  EXPECT_EQ(31u, found.cycle);
  EXPECT_THAT(found.what, HasSubstr("the last batch of source '"));
}

TEST_F(TwoRecordings, ABatchWithAnotherContentIsADifferenceOfInputs) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    const std::size_t first = report_of(messages, 1);
    alter<clearance_msg_PoseBatch>(
        messages[batch_before(messages, first)],
        [](clearance_msg_PoseBatch& batch) { batch.poses._buffer[0].position.x += 1e-12; });
    alter<clearance_msg_Distances>(messages[first],
                                   [](clearance_msg_Distances& report) { ++report.queries; });
  });
  EXPECT_EQ(Kind::kInputs, found.kind);
  EXPECT_EQ(1u, found.cycle);
  EXPECT_THAT(found.what, HasSubstr("batch 1 of source 'cell'"));
}

TEST_F(TwoRecordings, ABatchThatOnlyOneRecordingHasIsADifferenceOfInputs) {
  std::uint64_t removed = 0;
  const RecordingsDifference found = after([&](std::vector<Kept>& messages) {
    const std::size_t place = batch_before(messages, report_of(messages, 90));
    removed = decoded<clearance_msg_PoseBatch>(messages[place])->sequence_number;
    messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(place));
  });
  EXPECT_EQ(Kind::kInputs, found.kind);
  EXPECT_LE(found.cycle, 90u);
  EXPECT_GT(found.cycle, 80u);
  EXPECT_THAT(found.what, HasSubstr("batch " + std::to_string(removed) + " of source '"));
}

TEST_F(TwoRecordings, TicksAtOtherTimesAreNoFault) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    alter<clearance_msg_Distances>(messages[report_of(messages, 12)],
                                   [](clearance_msg_Distances& report) {
                                     report.now_ns += 40'000;
                                     report.pairs._buffer[0].age_a_ns += 40'000;
                                   });
  });
  EXPECT_EQ(Kind::kTime, found.kind);
  EXPECT_EQ(12u, found.cycle);
}

TEST_F(TwoRecordings, AnotherSceneIsToldBeforeAllElse) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    alter<clearance_msg_Distances>(messages[report_of(messages, 3)],
                                   [](clearance_msg_Distances& report) {
                                     ++report.scene_revision;
                                     ++report.now_ns;
                                     ++report.queries;
                                   });
  });
  EXPECT_EQ(Kind::kScene, found.kind);
  EXPECT_EQ(3u, found.cycle);
}

TEST_F(TwoRecordings, AMissingReportIsToldWithTheFileThatHasIt) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(report_of(messages, 77)));
  });
  EXPECT_EQ(Kind::kMissing, found.kind);
  EXPECT_EQ(77u, found.cycle);
  EXPECT_THAT(found.what, HasSubstr(run.string()));
}

TEST_F(TwoRecordings, OnlyTheCyclesThatBothHaveAreCompared) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    const auto before = static_cast<std::ptrdiff_t>(report_of(messages, 50));
    std::vector<Kept> kept(messages.begin() + before + 1, messages.end());
    std::erase_if(kept, [](const Kept& message) { return message.kind == TopicKind::kCatalogue; });
    kept.insert(kept.begin(), messages.front());
    messages = std::move(kept);
  });
  EXPECT_TRUE(found.is_same()) << found.error << found.what;
  EXPECT_EQ(51u, found.first_cycle);
  EXPECT_EQ(150u, found.compared);
}

TEST_F(TwoRecordings, AZoneThatIsActiveInOnlyOneIsADifferenceOfResults) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    for (Kept& message : messages) {
      if (message.kind != TopicKind::kZones) continue;
      if (!decoded<clearance_msg_ZoneState>(message)->active) continue;
      alter<clearance_msg_ZoneState>(message,
                                     [](clearance_msg_ZoneState& state) { state.active = false; });
      return;
    }
    FAIL() << "no zone is ever active in this run";
  });
  EXPECT_EQ(Kind::kResult, found.kind);
  EXPECT_THAT(found.what, HasSubstr("zone 'stop'"));
}

TEST_F(TwoRecordings, WithoutACycleInCommonAreAnError) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    std::erase_if(messages,
                  [](const Kept& message) { return message.kind == TopicKind::kDistances; });
  });
  EXPECT_FALSE(found.is_same());
  EXPECT_NE("", found.error);
  EXPECT_NE("", compare_recordings(run, run.parent_path() / "none.mcap").error);
}

TEST_F(TwoRecordings, ReportsOfTwoDaemonsInOneFileAreRefused) {
  const RecordingsDifference found = after([](std::vector<Kept>& messages) {
    alter<clearance_msg_Distances>(messages[report_of(messages, 9)],
                                   [](clearance_msg_Distances& report) { report.daemon = 7; });
  });
  EXPECT_FALSE(found.is_same());
  EXPECT_THAT(found.error, HasSubstr("other.mcap"));
}

}  // namespace
}  // namespace clearance::test
