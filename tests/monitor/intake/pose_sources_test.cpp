// The owner of each source name, and the sources that have a slot. No DDS is used.
#include "monitor/intake/pose_sources.hpp"

#include <gtest/gtest.h>

#include <string>

namespace clearance {
namespace {

using Admitted = Admission::News;

constexpr std::int64_t kBegin = 1'000'000'000'000, kSecond = 1'000'000'000, kOneMs = 1'000'000;

// Sends a batch of three poses. It is taken in if it is admitted.
Admission send(PoseSources& sources, const std::string& name, std::uint64_t writer,
               std::int64_t at_ns, std::uint64_t number = 1) {
  const Admission admission = sources.admit(SourceName(name), writer, 3, kBegin + at_ns);
  if (admission.tally != nullptr) {
    admission.tally->note_sequence(number);
    admission.tally->last_ns = kBegin + at_ns;
  }
  return admission;
}

TEST(PoseSources, LeaveANameToItsWriterAsLongAsThatOneSends) {
  PoseSources sources;
  for (std::uint64_t i = 1; i <= 1000; ++i) {
    const std::int64_t at = static_cast<std::int64_t>(i) * kOneMs;
    EXPECT_NE(send(sources, "arm", 7, at, i).tally, nullptr);
    const Admission second = send(sources, "arm", 8, at, 1'000'000'000 + i);
    EXPECT_EQ(second.tally, nullptr);
    EXPECT_EQ(second.news, i == 1 ? Admitted::kFirstRefusal : Admitted::kNothing);
    EXPECT_EQ(second.former_writer, 7u);
  }
  ASSERT_EQ(sources.tallies().size(), 1u);
  EXPECT_EQ(sources.tallies()[0].lost, 0u);
  ASSERT_EQ(sources.refused().size(), 1u);
  EXPECT_EQ(sources.refused()[0].cause, SourceRefusal::kOtherWriter);
  EXPECT_EQ(sources.refused()[0].poses, 3000u);
}

TEST(PoseSources, GiveANameToAnotherWriterAfterASecondOfSilence) {
  PoseSources sources;
  send(sources, "arm", 7, 0, 500);
  EXPECT_EQ(send(sources, "arm", 8, kSecond).tally, nullptr);
  const Admission taken = send(sources, "arm", 8, kSecond + 1, 1'968'028'530);
  ASSERT_NE(taken.tally, nullptr);
  EXPECT_EQ(taken.news, Admitted::kTakenOver);
  EXPECT_EQ(taken.former_writer, 7u);
  EXPECT_EQ(taken.tally->lost, 0u) << "the numbers of two writers say nothing about loss";
  EXPECT_EQ(send(sources, "arm", 7, kSecond + kOneMs).tally, nullptr) << "it is the other's now";
}

TEST(PoseSources, GiveANameToAnotherWriterAtOnceWhenItsOwnHasLeft) {
  PoseSources sources;
  send(sources, "arm", 7, 0);
  sources.keep(std::vector<std::uint64_t>{8});
  EXPECT_EQ(send(sources, "arm", 8, kOneMs).news, Admitted::kTakenOver);
}

TEST(PoseSources, CountGapsButNeitherARestartNorANewNumberingAsLoss) {
  PoseSources sources;
  for (const std::uint64_t number :
       {std::uint64_t{5}, std::uint64_t{9}, std::uint64_t{1}, std::uint64_t{2}, ~std::uint64_t{0},
        std::uint64_t{3}, std::uint64_t{1} << 62}) {
    send(sources, "arm", 7, 0, number);
  }
  EXPECT_EQ(sources.tallies()[0].lost, 3u) << "6, 7 and 8";
}

TEST(PoseSources, TakeNumberZeroAsNoNumber) {
  PoseSources sources;
  for (const std::uint64_t number : {5000, 0, 5001, 0, 0, 5002, 5004}) {
    send(sources, "arm", 7, 0, number);
  }
  EXPECT_EQ(sources.tallies()[0].lost, 1u) << "5003";
}

TEST(PoseSources, RefuseASourceWithoutAName) {
  PoseSources sources;
  const Admission admission = send(sources, "", 7, 0);
  EXPECT_EQ(admission.tally, nullptr);
  EXPECT_EQ(admission.cause, SourceRefusal::kNoName);
  EXPECT_EQ(admission.news, Admitted::kFirstRefusal);
  EXPECT_EQ(sources.refused().at(0).poses, 3u);
  EXPECT_TRUE(sources.tallies().empty());
}

// Fills all slots with sources, each from a different writer.
PoseSources all_places_taken() {
  PoseSources sources;
  for (std::uint64_t i = 1; i <= kMaxSources; ++i)
    send(sources, "source" + std::to_string(i), i, static_cast<std::int64_t>(i));
  return sources;
}

TEST(PoseSources, GiveThePlaceOfASourceWhoseWriterHasLeftToAnother) {
  PoseSources sources = all_places_taken();
  EXPECT_EQ(send(sources, "late", 99, kOneMs).cause, SourceRefusal::kTooMany);
  std::vector<std::uint64_t> still{99};
  for (std::uint64_t i = 1; i <= kMaxSources; ++i)
    if (i != 3) still.push_back(i);
  sources.keep(still);
  const Admission late = send(sources, "late", 99, 2 * kOneMs);
  EXPECT_EQ(late.news, Admitted::kNewSource);
  EXPECT_EQ(late.place_of.view(), "source3");
  EXPECT_EQ(sources.departed().batches, 0u);
  EXPECT_EQ(sources.tallies().size(), kMaxSources);
}

TEST(PoseSources, GiveThePlaceOfASourceThatIsSilentToAnother) {
  PoseSources sources = all_places_taken();
  for (std::uint64_t i = 1; i <= kMaxSources; ++i)
    if (i != 4) send(sources, "source" + std::to_string(i), i, 9 * kSecond);
  EXPECT_EQ(send(sources, "late", 99, 9 * kSecond).tally, nullptr);
  EXPECT_EQ(send(sources, "late", 99, 11 * kSecond).place_of.view(), "source4");
}

TEST(PoseSources, LetNoWriterLockOthersOutWithManyNames) {
  PoseSources sources;
  for (std::size_t i = 0; i < kMaxSources; ++i)
    send(sources, "name" + std::to_string(i), 1, static_cast<std::int64_t>(i));
  EXPECT_EQ(send(sources, "arm", 2, kOneMs).tally, nullptr);
  EXPECT_NE(send(sources, "arm", 2, kSecond + kOneMs).tally, nullptr);
}

TEST(PoseSources, KeepAPlaceForASourceThatTheCellNames) {
  PoseSources sources({SourceName("arm")});
  for (std::uint64_t i = 1; i <= kMaxSources; ++i) {
    const Admission other = send(sources, "other" + std::to_string(i), i, kOneMs);
    EXPECT_EQ(other.tally != nullptr, i < kMaxSources) << i;
  }
  EXPECT_NE(send(sources, "arm", 99, kOneMs).tally, nullptr);
  EXPECT_EQ(send(sources, "late", 100, 20 * kSecond).place_of.view(), "other1");
  EXPECT_NE(send(sources, "arm", 99, 40 * kSecond).tally, nullptr);
}

TEST(PoseSources, NameOnlyTheFirstOnesTheyRefuse) {
  PoseSources sources = all_places_taken();
  for (int i = 0; i < 1000; ++i) send(sources, "more" + std::to_string(i), 99, kOneMs);
  EXPECT_EQ(sources.refused().size(), 2 * kMaxSources + 1);
  EXPECT_TRUE(sources.refused().back().source.view().empty());
}

}  // namespace
}  // namespace clearance
