// Flat contacts: a planar face or a generator of one body is parallel to one of the other, or
// nearly so. Oracles: closed forms of the distance, and the ellipsoid method in 50 digits
// (tests/shared/curved_oracle.hpp).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/curved/tracking.hpp"
#include "core/distance.hpp"
#include "tests/shared/curved_judge.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using hard::box_of;
using hard::CurvedCase;
using hard::truncated_cone_of;
using oracle::CurvedBody;
using test::at;
using test::made;
using test::turned;

constexpr double kGaps[] = {1e-6, 1e-3, 0.5};
constexpr double kTilts[] = {0.0, 1e-13, 1e-9, 1e-4};
constexpr double kQuarterTurn = std::numbers::pi / 2.0;

CurvedBody cylinder_of(double radius, double half_length) {
  return truncated_cone_of(radius, radius, half_length);
}
CurvedBody capsule(double half_length, double radius) {
  CurvedBody body;
  body.points = {{0.0, 0.0, -half_length}, {0.0, 0.0, half_length}};
  body.radius = radius;
  return body;
}

// B is `gap` away from A if A is at the origin and B at this pose.
struct FlatContact {
  const char* name;
  CurvedBody a, b;
  Pose pose_b;
};

Pose lying(const Vec3& position) { return {position, turned(Vec3::UnitY(), kQuarterTurn)}; }

std::vector<FlatContact> parallel_contacts(double gap) {
  const CurvedBody plate = box_of({0.5, 0.4, 0.1}), drum = cylinder_of(0.3, 0.2);
  return {
      {"a cylinder on another", drum, cylinder_of(0.2, 0.4), at(0.25, 0.1, 0.6 + gap)},
      {"a cone's base on a cylinder", drum, truncated_cone_of(0.2, 0.0, 0.4),
       at(0.1, 0.3, 0.6 + gap)},
      {"a cylinder on a box", plate, cylinder_of(0.2, 0.4), at(0.4, 0.1, 0.5 + gap)},
      {"a box on a smaller cylinder", drum, plate, at(0.3, 0.1, 0.3 + gap)},
      {"a lying cylinder on a box", plate, cylinder_of(0.2, 0.3), lying({0.1, 0.1, 0.3 + gap})},
      {"a lying cylinder that ends outside a box", plate, cylinder_of(0.2, 0.7),
       lying({0.1, 0.1, 0.3 + gap})},
      {"a lying capsule on a cylinder", drum, capsule(0.5, 0.1), lying({0.1, 0.1, 0.3 + gap})},
      {"two cylinders side by side", drum, cylinder_of(0.2, 0.4), at(0.0, 0.5 + gap, 0.1)},
      {"a capsule beside a cylinder", drum, capsule(0.5, 0.1), at(0.4 + gap, 0.0, 0.2)},
  };
}

CurvedCase case_of(const FlatContact& contact) {
  CurvedCase c;
  c.a = contact.a;
  c.b = contact.b;
  c.pose_a = at(0.0, 0.0, 0.0);
  c.pose_b = contact.pose_b;
  return c;
}

struct FastAnswer {
  bool known;
  DistanceResult result;
};
// The answer of the fast effort alone.
FastAnswer fast_answer(const CurvedCase& c, CurvedTrackingState& state) {
  const ConvexBody a = made(hard::curved_model(c.a)), b = made(hard::curved_model(c.b));
  FastAnswer answer{};
  answer.known = newton_distance(a, b, relative_pose(c.pose_a, c.pose_b), state, answer.result);
  return answer;
}

void expect_no_faults(const CurvedCase& c, const DistanceResult& r) {
  for (const std::string& fault : CurvedJudge(c).faults(r)) ADD_FAILURE() << fault;
}

TEST(CurvedFlats, AreAnsweredByTheFastEffortAlone) {
  for (const double gap : kGaps) {
    for (const FlatContact& contact : parallel_contacts(gap)) {
      SCOPED_TRACE(std::string(contact.name) + ", gap " + std::to_string(gap));
      const CurvedCase c = case_of(contact);
      CurvedTrackingState state;
      const FastAnswer answer = fast_answer(c, state);
      ASSERT_TRUE(answer.known);
      EXPECT_EQ(answer.result.status, DistanceStatus::kConverged);
      EXPECT_NEAR(answer.result.distance, gap, 1e-15 * 4.0);
      expect_no_faults(c, answer.result);
    }
  }
}

TEST(CurvedFlats, AreAnsweredAgainFromTheirOwnState) {
  for (const FlatContact& contact : parallel_contacts(1e-3)) {
    SCOPED_TRACE(contact.name);
    CurvedCase c = case_of(contact);
    CurvedTrackingState state;
    for (int step = 0; step < 5; ++step) {
      const FastAnswer answer = fast_answer(c, state);
      ASSERT_TRUE(answer.known) << "step " << step;
      expect_no_faults(c, answer.result);
      c.pose_b.position += Vec3(1e-3, 2e-3, 1e-3);
    }
  }
}

// Generators that are nearly parallel to a face or to each other. The four pairs of their ends are
// then equally near, up to the tilt.
TEST(CurvedFlats, MayBeTiltedAlongAGenerator) {
  const CurvedBody plate = box_of({0.5, 0.4, 0.1}), drum = cylinder_of(0.3, 0.2);
  for (const double tilt : kTilts) {
    SCOPED_TRACE("tilt " + std::to_string(tilt * 1e14) + "e-14");
    std::vector<FlatContact> contacts = {
        {"lying", plate, cylinder_of(0.2, 0.7), lying({0.1, 0.1, 0.5})},
        {"beside", drum, cylinder_of(0.2, 0.4), at(0.0, 0.7, 0.1)},
        {"capsule", drum, capsule(0.5, 0.1), at(0.6, 0.0, 0.2)},
    };
    for (FlatContact& contact : contacts) {
      SCOPED_TRACE(contact.name);
      contact.pose_b.orientation = turned({1.0, 1.0, 0.0}, tilt) * contact.pose_b.orientation;
      const CurvedCase c = case_of(contact);
      CurvedTrackingState state;
      const FastAnswer answer = fast_answer(c, state);
      ASSERT_TRUE(answer.known);
      expect_no_faults(c, answer.result);
    }
  }
}

// Near contact, the second derivative across an edge is the distance itself, and that along a rim
// is its radius.
TEST(CurvedFlats, MayBeARimAndAnEdgeThatNearlyTouch) {
  const CurvedBody plate = box_of({0.5, 0.4, 0.1}), drum = cylinder_of(0.3, 0.2);
  const Vec3 n = Vec3(1.0, 0.0, 1.0).normalized();  // at right angles to the edge
  for (const double gap : {1e-9, 1e-6, 1e-3}) {
    SCOPED_TRACE("gap " + std::to_string(gap * 1e9) + "e-9");
    CurvedCase c;
    c.a = plate;
    c.b = drum;
    c.pose_a = at(0.0, 0.0, 0.0);
    c.pose_b.orientation = turned({1.0, 0.3, 0.0}, 0.4);
    const Vec3 m = c.pose_b.orientation.conjugate() * n;
    const double across = std::hypot(m.x(), m.y());
    const Vec3 lowest(-0.3 * m.x() / across, -0.3 * m.y() / across, m.z() > 0.0 ? -0.2 : 0.2);
    c.pose_b.position = Vec3(0.5, 0.1, 0.1) + gap * n - c.pose_b.orientation * lowest;
    CurvedTrackingState state;
    const FastAnswer answer = fast_answer(c, state);
    ASSERT_TRUE(answer.known);
    EXPECT_NEAR(answer.result.distance, gap, 1e-14);
    expect_no_faults(c, answer.result);
  }
}

}  // namespace
}  // namespace clearance
