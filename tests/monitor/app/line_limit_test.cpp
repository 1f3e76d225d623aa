#include "monitor/app/line_limit.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/shared/logged.hpp"

namespace clearance {
namespace {

TEST(LineLimit, AdmitsFiveLinesASecondAndThenTellsHowManyWereLeftOut) {
  const auto logged = std::make_shared<test::Logged>();
  const test::LoggedTo to(logged);
  LineLimit limit(lines::kCommandsLeftOut);
  int admitted = 0;
  for (std::int64_t ms = 0; ms < 3000; ++ms) admitted += limit.admits(ms * 1'000'000) ? 1 : 0;
  EXPECT_EQ(admitted, 15);
  EXPECT_EQ(logged->count("995 lines about refused commands left out"), 2u) << logged->text();
  EXPECT_TRUE(limit.admits(9'000'000'000));
  EXPECT_EQ(logged->count("995 lines"), 3u);
  EXPECT_TRUE(limit.admits(10'000'000'000));
  EXPECT_EQ(logged->count("left out"), 3u) << "none was left out since";
}

}  // namespace
}  // namespace clearance
