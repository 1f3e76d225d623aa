#include "monitor/dds/name_limit.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

constexpr std::int64_t kNow = 5'000'000'000;

TEST(NameLimit, AdmitsSixteenNamesOfAWriterAtATime) {
  NameLimit limit;
  for (std::uint64_t name = 1; name <= 1000; ++name) {
    EXPECT_EQ(limit.admits(7, name, kNow), name <= NameLimit::kNames) << name;
  }
  EXPECT_EQ(limit.refused(), 1000 - NameLimit::kNames);
  EXPECT_TRUE(limit.admits(7, 1, kNow)) << "a name that it uses already";
  EXPECT_TRUE(limit.admits(8, 1001, kNow)) << "another writer";
}

TEST(NameLimit, ForgetsWhatIsNotUsedAnyLonger) {
  NameLimit limit;
  for (std::uint64_t name = 1; name <= NameLimit::kNames; ++name) {
    EXPECT_TRUE(limit.admits(7, name, kNow + static_cast<std::int64_t>(name)));
  }
  EXPECT_FALSE(limit.admits(7, 100, kNow + NameLimit::kForgottenNs));
  EXPECT_TRUE(limit.admits(7, 100, kNow + NameLimit::kForgottenNs + 1));
  EXPECT_FALSE(limit.admits(7, 101, kNow + NameLimit::kForgottenNs + 1));
  limit.forget_name(100);
  EXPECT_TRUE(limit.admits(7, 101, kNow + NameLimit::kForgottenNs + 1));
}

TEST(NameLimit, BoundsTheNamesOfAWriterInAll) {
  NameLimit limit;
  std::uint64_t admitted = 0;
  for (std::uint64_t name = 1; name <= 5000; ++name) {
    admitted += limit.admits(7, name, kNow + static_cast<std::int64_t>(name) * kNow);
  }
  EXPECT_EQ(admitted, NameLimit::kNamesInAll);
  limit.keep({});
  EXPECT_TRUE(limit.admits(7, 6000, kNow)) << "that writer has left, and Cyclone has freed them";
}

}  // namespace
}  // namespace clearance
