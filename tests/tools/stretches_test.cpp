// The stretches of a run, compared with all values that were added.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "tools/view/stretches.hpp"

namespace clearance {
namespace {

struct Head {
  std::int64_t begin_ns = 0;
  int added = 1;
};
struct Least {
  double least = std::numeric_limits<double>::infinity();
};
void merge(const Head& later, Head& into) { into.added += later.added; }
void merge(const Least& later, Least& into) { into.least = std::min(into.least, later.least); }

struct Added {
  std::int64_t time_ns;
  double value[2];
};

TEST(Stretches, HoldOfEachTimeTheLeastThatWasAddedHoweverLongTheRunIs) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> pause(0, 30);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const int count : {1, 2, 8, 9, 1000}) {
    SCOPED_TRACE(count);
    Stretches<Head, Least> run(2, 8, 3);
    std::vector<Added> all;
    std::int64_t time_ns = 1'000'000;
    for (int i = 0; i < count; ++i, time_ns += pause(random)) {
      all.push_back({time_ns, {any(random), any(random)}});
      const std::span<Least> cells = run.add({.begin_ns = time_ns});
      for (std::size_t column = 0; column < 2; ++column) {
        merge(Least{all.back().value[column]}, cells[column]);
      }
    }
    ASSERT_LE(run.heads().size(), 8u);
    auto next = all.begin();
    for (std::size_t stretch = 0; stretch < run.heads().size(); ++stretch) {
      ASSERT_NE(next, all.end());
      EXPECT_EQ(run.heads()[stretch].begin_ns, next->time_ns);
      const auto end = next + run.heads()[stretch].added;
      for (std::size_t column = 0; column < 2; ++column) {
        double least = std::numeric_limits<double>::infinity();
        for (auto each = next; each != end; ++each) least = std::min(least, each->value[column]);
        EXPECT_EQ(run.cells(stretch)[column].least, least);
      }
      next = end;
    }
    EXPECT_EQ(next, all.end());
  }
}

TEST(Stretches, KeepApartWhatTheyHaveRoomFor) {
  Stretches<Head, Least> run(0, 100, 10);
  for (std::int64_t i = 0; i < 100; ++i) run.add({.begin_ns = 10 * i});
  EXPECT_EQ(run.heads().size(), 100u);
  run.add({.begin_ns = 1000});
  EXPECT_EQ(run.heads().size(), 51u);
}

TEST(Stretches, KeepTheirValuesWhenTheyAreWidened) {
  Stretches<Head, Least> run(1, 8, 3);
  for (std::int64_t ns = 0; ns < 24; ns += 3)
    run.add({.begin_ns = ns})[0].least = static_cast<double>(ns);
  run.widen(2, 4);
  EXPECT_EQ(run.heads().size(), 4u);
  run.add({.begin_ns = 23})[1].least = -1.0;
  for (std::size_t i = 0; i < run.heads().size(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_EQ(run.cells(i).size(), 2u);
    EXPECT_EQ(run.cells(i)[0].least, 6.0 * static_cast<double>(i));
    const bool is_last = i + 1 == run.heads().size();
    EXPECT_EQ(run.cells(i)[1].least, is_last ? -1.0 : Least{}.least) << "no value before";
  }
}

}  // namespace
}  // namespace clearance
