// A query of curved bodies keeps the sound parts of a tracking state and forgets nonsense.
#include "core/curved/tracking.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/shapes.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

using test::made;

// The parts of a cube are its 8 vertices, and those of a cylinder its 2 discs. Their planar faces
// follow: 6 facets, and 2 caps.
TEST(CurvedTracking, ForgetsPartsThatTheBodiesDoNotHaveOrThatMayNotBeActiveTogether) {
  const ConvexBody cube = test::cube(), drum = made(cylinder(0.5, 1.0)),
                   ball = made(ellipsoid({1, 1, 1})), floor = test::half_space({0, 0, 1}, 0.0);
  using Pairs = std::array<PartPair, 3>;
  const struct {
    const char* name;
    const ConvexBody& a;
    std::size_t count;
    Pairs pairs;
    std::size_t kept;
  } cases[] = {
      {"vertices and discs", cube, 3, Pairs{{{0, 0}, {7, 1}, {3, 0}}}, 3},
      {"more pairs than there are places for", cube, 4, {}, 0},
      {"a vertex that the cube does not have", cube, 1, Pairs{{{14, 0}}}, 0},
      {"a part below zero", cube, 1, Pairs{{{-1, 0}}}, 0},
      {"a facet and a disc", cube, 1, Pairs{{{13, 1}}}, 1},
      {"a vertex and a cap", cube, 1, Pairs{{{7, 3}}}, 1},
      {"a cap that the cylinder does not have", cube, 1, Pairs{{{7, 4}}}, 0},
      {"a facet and a cap", cube, 1, Pairs{{{8, 2}}}, 0},
      {"a facet among several pairs", cube, 2, Pairs{{{8, 0}, {1, 1}}}, 0},
      {"the second part of an ellipsoid", ball, 1, Pairs{{{1, 0}}}, 0},
      {"a facet of an unbounded body", floor, 1, Pairs{{{50, 0}}}, 0},
  };
  for (const auto& [name, a, count, pairs, kept] : cases) {
    CurvedTrackingState state;
    state.normal = Vec3::UnitX();
    state.active.pairs = pairs;
    state.active.count = count;
    forget_nonsense(state, a, drum);
    EXPECT_EQ(state.active.count, kept) << name;
    EXPECT_EQ(state.normal, Vec3::UnitX()) << name;
  }
}

TEST(CurvedTracking, ForgetsANormalThatIsFarFromUnitLength) {
  const ConvexBody ball = made(ellipsoid({1, 1, 1}));
  for (const auto& [length, kept] :
       {std::pair{1.0, true}, {0.8, true}, {0.5, false}, {1.5, false}, {HUGE_VAL, false}}) {
    CurvedTrackingState state;
    state.normal = length * Vec3(0.0, 1.0, 0.0);
    state.normal.x() = state.normal.z() = 0.0;
    forget_nonsense(state, ball, ball);
    EXPECT_EQ(!state.normal.isZero(0.0), kept) << length;
  }
}

TEST(CurvedTracking, PacksEveryPairThatFitsAndNoOther) {
  constexpr std::int32_t kLast = (1 << 19) - 2;
  for (const bool b_is_curved : {false, true}) {
    for (const std::int32_t part : {0, 1, 77, kLast}) {
      for (std::int32_t other = 0; other < 4; ++other) {
        const PartPair pair = b_is_curved ? PartPair{part, other} : PartPair{other, part};
        EXPECT_EQ(unpacked(packed(pair, b_is_curved), b_is_curved), pair) << part << ' ' << other;
      }
    }
    const PartPair far = b_is_curved ? PartPair{kLast + 2, 0} : PartPair{0, kLast + 2};
    EXPECT_EQ(packed(far, b_is_curved), 0U);
  }
}

}  // namespace
}  // namespace clearance
