// States as bytes that were cut or forged, and times and values at the ends of their range.
//
// Oracle for times: long double, which has 64 bits or more.
#include "monitor/inputs/state_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/refused_value.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMost = 4;

struct Taken {
  std::uint64_t number = 0;
  std::array<std::uint16_t, 3> fixed{};
  std::vector<std::uint32_t> list;
  bool is_good = false, is_complete = false;
};
Taken taken(std::span<const std::byte> bytes) {
  StateReader in(bytes);
  Taken taken;
  in.take(taken.number);
  in.take(std::span<std::uint16_t>(taken.fixed));
  in.take_list(taken.list, kMost);
  taken.is_good = in.good();
  taken.is_complete = in.complete();
  return taken;
}
std::vector<std::byte> written(std::span<const std::uint16_t> fixed,
                               std::span<const std::uint32_t> list) {
  std::vector<std::byte> bytes;
  StateWriter out(bytes);
  out.put(std::uint64_t{7});
  out.put(fixed);
  out.put(list);
  return bytes;
}

TEST(StateBytes, AreTakenOutAsTheyWerePutInAndNothingRemains) {
  const std::array<std::uint16_t, 3> fixed{1, 2, 3};
  for (std::uint32_t count = 0; count <= kMost; ++count) {
    const std::vector<std::uint32_t> list(count, 9);
    std::vector<std::byte> bytes = written(fixed, list);
    const Taken whole = taken(bytes);
    EXPECT_TRUE(whole.is_complete);
    EXPECT_EQ(whole.number, 7u);
    EXPECT_EQ(whole.fixed, fixed);
    EXPECT_EQ(whole.list, list);
    bytes.push_back(std::byte{0});
    EXPECT_TRUE(taken(bytes).is_good);
    EXPECT_FALSE(taken(bytes).is_complete) << "a byte remains";
  }
}

TEST(StateBytes, ThatAreCutAtAnyPlaceAreRefused) {
  const std::array<std::uint16_t, 3> fixed{1, 2, 3};
  const std::array<std::uint32_t, 2> list{4, 5};
  const std::vector<std::byte> bytes = written(fixed, list);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(taken(std::span(bytes).first(size)).is_good) << size << " bytes";
}

TEST(StateBytes, WithAListOfAnotherLengthAreRefusedAndSoIsAllThatFollows) {
  const std::array<std::uint16_t, 4> fixed{1, 2, 3, 4};
  const std::array<std::uint32_t, kMost + 1> list{};
  for (const std::size_t count : {0, 2, 4})
    EXPECT_FALSE(taken(written(std::span(fixed).first(count), {})).is_good) << count;
  const Taken longer = taken(written(std::span(fixed).first(3), list));
  EXPECT_FALSE(longer.is_good);
  EXPECT_TRUE(longer.list.empty()) << "no memory is taken for a list that is refused";
  StateReader in({});
  in.expect(true);
  EXPECT_TRUE(in.complete());
  in.expect(false);
  in.expect(true);
  EXPECT_FALSE(in.good());
}

TEST(StateBytes, OfAFlagAreThoseOfTrueOrFalse) {
  for (int byte = 0; byte < 256; ++byte) {
    bool flag = false;
    std::memset(&flag, byte, 1);
    EXPECT_EQ(are_flags(flag), byte <= 1);
    const bool sound = true;
    EXPECT_EQ(are_flags(sound, flag, sound), byte <= 1);
  }
}

TEST(Elapsed, SaturatesWhereADifferenceLeavesTheRange) {
  using Wide = long double;
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min(),
                         kLargest = std::numeric_limits<std::int64_t>::max();
  constexpr std::array<std::int64_t, 9> kTimes{kLeast, kLeast + 1,       kLeast / 2,   -1,      0,
                                               1,      kLargest / 2 + 1, kLargest - 1, kLargest};
  for (const std::int64_t a : kTimes) {
    for (const std::int64_t b : kTimes) {
      const Wide exact = static_cast<Wide>(a) - static_cast<Wide>(b);
      const std::int64_t within = exact < kLeast     ? kLeast
                                  : exact > kLargest ? kLargest
                                                     : static_cast<std::int64_t>(exact);
      EXPECT_EQ(less(a, b), within) << a << " - " << b;
      EXPECT_EQ(elapsed(b, a), std::max<std::int64_t>(within, 0)) << a << " - " << b;
    }
  }
}

TEST(RefusedValue, BeyondTheRangeOfFloatsIsInfiniteWithItsSign) {
  for (const double sign : {1.0, -1.0}) {
    const auto rounded = [sign](double position) {
      const JointSample sample{.variable = 0, .stamp_ns = 0, .position = sign * position};
      return RefusedValue(Reject::kNonFinite, sample, 0).value[0];
    };
    EXPECT_EQ(rounded(1e300), sign * std::numeric_limits<float>::infinity());
    EXPECT_EQ(rounded(std::numeric_limits<double>::infinity()),
              sign * std::numeric_limits<float>::infinity());
    EXPECT_EQ(rounded(0.5), sign * 0.5F);
    EXPECT_TRUE(std::isnan(rounded(std::numeric_limits<double>::quiet_NaN())));
  }
}

}  // namespace
}  // namespace clearance
