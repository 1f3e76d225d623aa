#include "config/cell/simulation.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace clearance {
namespace {

constexpr double kPi = std::numbers::pi;

// Two revolute joints and a slide with oblique axes, on a rotated base, and beside them a spinning
// object.
Simulation moving_cell() {
  Simulation simulation;
  const Eigen::Quaterniond turned = Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
  SimulatedChain chain;
  chain.world_from_base = {Vec3(0.4, -0.2, 0.1), turned};
  chain.joints.push_back({.objects = {0},
                          .parent_from_joint = {Vec3(0.1, 0.2, 0.3), turned.conjugate()},
                          .axis = Vec3(1.0, 2.0, 2.0) / 3.0,
                          .motion = {0.3, 1.1, 0.7, 0.2}});
  chain.joints.push_back({.objects = {1},
                          .parent_from_joint = {Vec3(-0.3, 0.1, 0.5), turned},
                          .axis = Vec3::UnitY(),
                          .kind = JointKind::kPrismatic,
                          .motion = {0.1, 0.2, 0.9, -1.0}});
  chain.joints.push_back({.objects = {2},
                          .parent_from_joint = {Vec3(0.0, 0.4, 0.0), turned},
                          .axis = Vec3::UnitX(),
                          .motion = {-0.5, 0.8, 1.3, 2.0}});
  simulation.chains.push_back(chain);
  simulation.movers.push_back({.object = 3,
                               .centre = {Vec3(1.0, 1.0, 1.0), turned},
                               .amplitude = Vec3(0.1, -0.2, 0.3),
                               .frequency_hz = 0.8,
                               .phase = 0.4,
                               .spin = Vec3(0.5, -1.0, 2.0)});
  return simulation;
}

std::vector<PoseAt> at(const Simulation& simulation, double t_s) {
  std::vector<PoseAt> poses;
  poses_at(simulation, t_s, poses);
  return poses;
}

TEST(Simulation, TwistIsTheDerivativeOfThePose) {
  const Simulation simulation = moving_cell();
  const double step = 1e-5;
  // a point of the object that rotation and translation both move
  const Vec3 point(0.2, -0.1, 0.3);
  for (const double t : {0.0, 0.31, 1.7, 12.9}) {
    const auto before = at(simulation, t - step), now = at(simulation, t),
               after = at(simulation, t + step);
    ASSERT_EQ(now.size(), 4u);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Vec3 difference = (transform(after[i].world_from_object, point) -
                               transform(before[i].world_from_object, point)) /
                              (2.0 * step);
      const Vec3 arm =
          transform(now[i].world_from_object, point) - now[i].world_from_object.position;
      const Vec3 stated = now[i].twist.linear + now[i].twist.angular.cross(arm);
      EXPECT_LT((difference - stated).norm(), 1e-7) << "object " << i << " at " << t << " s";
    }
  }
}

TEST(Simulation, APlanarArmIsWhereTheClosedFormPutsIt) {
  Simulation simulation;
  SimulatedChain chain;
  chain.joints.push_back({.objects = {0}, .motion = {kPi / 2.0, 0.0, 0.0, 0.0}});
  chain.joints.push_back(
      {.objects = {1},
       .parent_from_joint = {Vec3(2.0, 0.0, 0.0), Eigen::Quaterniond::Identity()},
       .motion = {0.0, kPi / 2.0, 0.25, 0.0}});
  simulation.chains.push_back(chain);
  const auto poses =
      at(simulation, 1.0);  // after a quarter period the second joint is at 90 degrees
  EXPECT_LT((poses[1].world_from_object.position - Vec3(0.0, 2.0, 0.0)).norm(), 1e-15);
  EXPECT_LT(
      (transform(poses[1].world_from_object, Vec3(1.0, 0.0, 0.0)) - Vec3(-1.0, 2.0, 0.0)).norm(),
      1e-15);
}

TEST(Simulation, SameInstantGivesTheSameBits) {
  const Simulation simulation = moving_cell();
  std::vector<PoseAt> reused = at(simulation, 3.0);
  poses_at(simulation, 1234.567, reused);
  const auto fresh = at(simulation, 1234.567);
  ASSERT_EQ(reused.size(), fresh.size());
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    EXPECT_EQ(reused[i].world_from_object.position, fresh[i].world_from_object.position);
    EXPECT_EQ(reused[i].world_from_object.orientation.coeffs(),
              fresh[i].world_from_object.orientation.coeffs());
    EXPECT_NEAR(fresh[i].world_from_object.orientation.norm(), 1.0, 1e-15);
  }
}

}  // namespace
}  // namespace clearance
