// The cells under config/cells: the claims in their comments, and the plausibility of their motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "core/model/curved_extent.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/places.hpp"

namespace clearance {
namespace {

Cell shipped(const std::string& name) {
  CellResult result = read_cell(test::places::sources() + "/config/cells/" + name);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result)) {
    for (const CellError& error : *errors) ADD_FAILURE() << error.text;
    return {};
  }
  return std::get<Cell>(std::move(result));
}

bool in_group(const Object& object, const std::string& group) {
  return std::find(object.groups.begin(), object.groups.end(), group) != object.groups.end();
}

// The truth about one instant of a cell's motion: every pair's lower bound.
class Instant {
 public:
  explicit Instant(const Cell& cell)
      : scene_(cell.scene), simulation_(cell.simulation), poses_(scene_.objects.size()) {
    for (std::size_t i = 0; i < poses_.size(); ++i) poses_[i] = scene_.objects[i].world_from_object;
  }

  void move_to(double t_s) {
    poses_at(simulation_, t_s, moving_);
    for (const PoseAt& at : moving_) poses_[at.object] = at.world_from_object;
  }

  double clearance(const ObjectPair& pair) const {
    double least = kInfinity;
    for (const Part& a : scene_.objects[pair.first].parts) {
      for (const Part& b : scene_.objects[pair.second].parts) {
        const RelativePose a_from_b =
            relative_pose(compose(poses_[pair.first], a.object_from_part),
                          compose(poses_[pair.second], b.object_from_part));
        TrackingState state;
        least = std::min(least, distance(a.shape, b.shape, a_from_b, state).lower);
      }
    }
    return least;
  }

  const std::vector<PoseAt>& moving() const { return moving_; }

 private:
  const Scene& scene_;
  const Simulation& simulation_;
  std::vector<Pose> poses_;
  std::vector<PoseAt> moving_;
};

// Steps through the ten seconds of a shipped motion.
constexpr double kPeriod = 10.0;  // s
constexpr double kStep = 0.05;

double least_clearance(const Cell& cell) {
  const Scene& scene = cell.scene;
  Instant instant(cell);
  double least = kInfinity;
  for (double t = 0.0; t < kPeriod; t += kStep) {
    instant.move_to(t);
    for (const ObjectPair& pair : scene.pairs) least = std::min(least, instant.clearance(pair));
  }
  return least;
}

std::set<std::string> zones_entered(const Cell& cell) {
  const Scene& scene = cell.scene;
  Instant instant(cell);
  std::set<std::string> entered;
  for (double t = 0.0; t < kPeriod; t += kStep) {
    instant.move_to(t);
    for (const Zone& zone : scene.zones) {
      for (const std::uint32_t pair : zone.pairs) {
        if (instant.clearance(scene.pairs[pair]) < zone.enter_below) entered.insert(zone.name);
      }
    }
  }
  return entered;
}

// During the motion, the speed of the fastest point of any part never exceeds the speed that the
// object states.
void expect_stated_speeds(const Cell& cell) {
  const Scene& scene = cell.scene;
  Instant instant(cell);
  for (double t = 0.0; t < kPeriod; t += kStep) {
    instant.move_to(t);
    for (const PoseAt& at : instant.moving()) {
      const Object& object = scene.objects[at.object];
      for (const Part& part : object.parts) {
        std::vector<Vec3> points = surface_points(part.shape.curved, 32);
        points.insert(points.end(), part.shape.anchors.begin(), part.shape.anchors.end());
        for (const Vec3& own : points) {
          const Vec3 point = transform(at.world_from_object, transform(part.object_from_part, own));
          const Vec3 arm = point - at.world_from_object.position;
          const double speed = (at.twist.linear + at.twist.angular.cross(arm)).norm() +
                               at.twist.angular.norm() * part.shape.radius;
          ASSERT_LE(speed, object.max_speed) << object.name << " at " << t << " s";
        }
      }
    }
  }
}

// Every moving object moves, and returns after the period.
void expect_whole_motion(const Cell& cell) {
  const Scene& scene = cell.scene;
  std::vector<PoseAt> start, end;
  poses_at(cell.simulation, 0.0, start);
  poses_at(cell.simulation, kPeriod, end);
  const auto moving = std::count_if(scene.objects.begin(), scene.objects.end(),
                                    [](const Object& object) { return !object.fixed; });
  ASSERT_EQ(start.size(), static_cast<std::size_t>(moving));
  for (std::size_t i = 0; i < start.size(); ++i) {
    const std::string& name = scene.objects[start[i].object].name;
    EXPECT_LT((start[i].world_from_object.position - end[i].world_from_object.position).norm(),
              1e-9)
        << name;
    EXPECT_LT(start[i].world_from_object.orientation.angularDistance(
                  end[i].world_from_object.orientation),
              1e-6)
        << name;
  }
}

TEST(McIntyreCell, HasTheThesisCounts) {
  const Cell cell = shipped("mcintyre.yaml");
  const Scene& scene = cell.scene;
  std::size_t polyhedra = 0, facets = 0;
  for (const Object& object : scene.objects) {
    if (!in_group(object, "arm")) continue;
    ASSERT_EQ(object.parts.size(), 1u);
    const ConvexBody& shape = object.parts[0].shape;
    EXPECT_LE(shape.facets.size(), 10u) << object.name;
    EXPECT_EQ(shape.radius, 0.0);
    ++polyhedra;
    facets += shape.facets.size();
  }
  EXPECT_EQ(polyhedra, 14u);
  EXPECT_EQ(facets, 96u);
  EXPECT_EQ(scene.pairs.size(), 25u);
  ASSERT_EQ(scene.objects.size(), 16u);
  EXPECT_EQ(scene.objects[14].name, "workspace");
  EXPECT_TRUE(scene.objects[14].parts[0].shape.bounded());
  EXPECT_EQ(scene.objects[15].name, "floor");
  EXPECT_EQ(scene.objects[15].parts[0].shape.facets.size(), 1u);
  for (const ObjectPair& pair : scene.pairs) {
    EXPECT_LT(pair.first, 14u);  // no pair within one arm
    EXPECT_GE(pair.second, 14u);
  }
}

TEST(McIntyreCell, MovesWithoutTouchingAndEntersItsZones) {
  const Cell cell = shipped("mcintyre.yaml");
  expect_whole_motion(cell);
  expect_stated_speeds(cell);
  EXPECT_GT(least_clearance(cell), 0.02);
  EXPECT_EQ(zones_entered(cell), (std::set<std::string>{"slow", "stop", "low"}));
}

TEST(TwoArmsCell, HasTwoSevenJointArmsAndThirtyObstacles) {
  const Cell cell = shipped("two_arms.yaml");
  const Scene& scene = cell.scene;
  const auto members = [&](const std::string& group) {
    return std::count_if(scene.objects.begin(), scene.objects.end(),
                         [&](const Object& object) { return in_group(object, group); });
  };
  EXPECT_EQ(members("left_arm"), 8);
  EXPECT_EQ(members("right_arm"), 8);
  EXPECT_EQ(members("obstacles"), 30);
  ASSERT_EQ(cell.simulation.chains.size(), 2u);
  EXPECT_EQ(cell.simulation.chains[0].joints.size(), 7u);
  EXPECT_EQ(cell.simulation.chains[1].joints.size(), 7u);
  // Within an arm: 2 x (28 - 7 adjacent - 2 at a constant distance). Between the arms: 8 x 8 less
  // the two fixed bases. Obstacles: 14 moving links x 30 less 2 pedestals, and 2 bases x 3 moving
  // obstacles.
  EXPECT_EQ(scene.pairs.size(), 2u * 19u + 63u + 14u * 30u - 2u + 6u);
}

TEST(TwoArmsCell, UsesEveryKindOfShape) {
  const std::string yaml = shipped("two_arms.yaml").yaml;
  for (const char* kind : {"box:", "sphere:", "capsule:", "prism:", "vertices:", "half_spaces:",
                           "half_space:", "mesh:"}) {
    EXPECT_NE(yaml.find(kind), std::string::npos) << kind;
  }
}

TEST(TwoArmsCell, MovesWithoutTouchingAndEntersItsZones) {
  const Cell cell = shipped("two_arms.yaml");
  expect_whole_motion(cell);
  expect_stated_speeds(cell);
  EXPECT_GT(least_clearance(cell), 0.02);
  EXPECT_EQ(zones_entered(cell), (std::set<std::string>{"slow", "stop", "hands_slow"}));
}

TEST(RoundArmCell, IsOfCurvedAndRoundedBodiesOnly) {
  const Cell cell = shipped("round_arm.yaml");
  const Scene& scene = cell.scene;
  for (const Object& object : scene.objects) {
    for (const Part& part : object.parts) {
      const ConvexBody& shape = part.shape;
      EXPECT_TRUE(shape.is_curved() || shape.radius > 0.0 || !shape.bounded()) << object.name;
    }
  }
  for (const char* kind : {"ellipsoid:", "cylinder:", "cone:", "truncated_cone:", "rounding:"}) {
    EXPECT_NE(cell.yaml.find(kind), std::string::npos) << kind;
  }
}

TEST(RoundArmCell, MovesWithoutTouchingAndEntersItsZones) {
  const Cell cell = shipped("round_arm.yaml");
  expect_whole_motion(cell);
  expect_stated_speeds(cell);
  EXPECT_GT(least_clearance(cell), 0.02);
  EXPECT_EQ(zones_entered(cell), (std::set<std::string>{"slow", "stop"}));
}

}  // namespace
}  // namespace clearance
