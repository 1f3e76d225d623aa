// The state that queries carry over motion, frames and removed elements. Oracle: the
// core's query of the part and each element that is left, without a state.
#include "monitor/clouds/cloud_tracking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::cloud_tracking_test {
namespace {

using test::made;

struct Bounds {
  double lower = kInfinity, upper = kInfinity;

  void add(const DistanceResult& r, double radius) {
    lower = std::min(lower, r.lower - radius);
    upper = std::min(upper, r.upper - radius);
  }
};

Bounds by_brute_force(const ConvexBody& part, const DepthCloud& cloud, SlabBody& body,
                      const RelativePose& pose) {
  Bounds least;
  for (std::size_t b = 0; b < cloud.blocks(); ++b) {
    if (DepthCloud::is_empty(cloud.node(0, b))) continue;
    for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
      if (cloud.block(b).low[lane] > cloud.block(b).high[lane]) continue;
      TrackingState state;
      least.add(distance(part, body.of(cloud.pixel_slab(b, lane)), pose, state), 0.0);
    }
  }
  return least;
}

Bounds by_brute_force(const ConvexBody& part, const PointCloud& cloud, const RelativePose& pose) {
  Bounds least;
  for (std::size_t b = 0; b < cloud.blocks(); ++b) {
    const PointCloud::Block& block = cloud.block(b);
    for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
      if (!block.is_present(lane)) continue;
      TrackingState state;
      RelativePose at;
      at.translation =
          pose.rotation * Vec3(block.x[lane], block.y[lane], block.z[lane]) + pose.translation;
      at.translation_error = pose.translation_error + 1e-14;
      least.add(distance(part, cloud.origin(), at, state), block.radius[lane]);
    }
  }
  return least;
}

void expect_agrees(const ConvexBody& part, const NearestElement& got, const Bounds& truth,
                   const std::string& of) {
  ASSERT_EQ(got.answer, CloudAnswer::kNearest) << of;
  EXPECT_LE(got.lower, truth.upper + 1e-14) << of;
  EXPECT_GE(got.upper, truth.lower - 1e-14) << of;
  EXPECT_LE(got.upper - got.lower, 1e-9) << of;
  // The core's points of a curved body that overlaps a slab can be off along the normal.
  if (part.is_curved() && got.upper < 0.0) return;
  EXPECT_NEAR((got.point_on_element - got.point_on_part).dot(got.normal), got.upper, 2e-9) << of;
}

std::vector<ConvexBody> parts() {
  std::vector<ConvexBody> out;
  out.push_back(made(box({0.05, 0.06, 0.12})));
  out.push_back(made(segment({0, 0, -0.2}, {0, 0, 0.2}, 0.07)));
  out.push_back(made(hard::facet_ball(4)));
  out.push_back(made(cylinder(0.1, 0.3)));
  out.push_back(test::half_space({0, 0.6, 0.8}, 0.1));
  return out;
}

// Small motion, and now and then a leap.
void move(Random& random, Pose& pose) {
  if (random.chance(0.05)) {
    pose = random.pose(0.6);
    pose.position.z() += 1.2;
    return;
  }
  pose.position += random.log_uniform(1e-6, 5e-3) * random.direction();
  const double angle = random.log_uniform(1e-6, 1e-2);
  pose.orientation =
      (pose.orientation * Eigen::Quaterniond(Eigen::AngleAxisd(angle, random.direction())))
          .normalized();
}

// A slanted wall with noise and a step, some of it missing.
std::vector<float> frame(Random& random, std::uint32_t width, std::uint32_t height) {
  const double middle = random.uniform(0.9, 1.6), slope = random.uniform(-0.4, 0.4);
  const double noise = random.log_uniform(1e-5, 0.05);
  std::vector<float> depth;
  for (std::uint32_t v = 0; v < height; ++v) {
    for (std::uint32_t u = 0; u < width; ++u) {
      double z = middle + slope * u / width + noise * random.uniform(-1.0, 1.0);
      if (u * 3 < width) z -= 0.3;
      const bool is_missing = random.chance(0.05) || (v < 9 && u > 20);
      depth.push_back(is_missing ? 0.0F : static_cast<float>(z));
    }
  }
  return depth;
}

TEST(CloudTracking, CarriedBoundsOfSlabsHoldOverMotionFramesAndRemovedPixels) {
  const std::vector<ConvexBody> all = parts();
  SlabBody body, scratch;
  for (int seed = 0; seed < 2; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 11);
    DepthCloud cloud(64, 48);
    std::vector<std::unique_ptr<CloudTracking>> tracking;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < all.size(); ++i) {
      tracking.push_back(std::make_unique<CloudTracking>());
      poses.push_back(random.pose(0.4));
      poses.back().position.z() += 0.8;
    }
    for (int step = 0; step < 40; ++step) {
      if (step % 10 == 0) {
        const bool small = random.chance(0.3);
        const std::uint32_t width = small ? 40 : 64, height = small ? 30 : 48;
        const std::vector<float> depth = frame(random, width, height);
        const PinholeCamera camera{width, height, 60.0, 61.0, 0.5 * width, 0.5 * height};
        const DepthImage image{DepthImage::Format::kMetres32, width, height, width * 4U,
                               std::as_bytes(std::span(depth))};
        ASSERT_EQ(cloud.build(camera, image, {0.001, 0.0025}, {0.25, 4.0}), DepthBuild::kBuilt);
      }
      if (step % 7 == 3) {
        const auto b = static_cast<std::size_t>(random.integer(0, int(cloud.blocks()) - 1));
        for (std::size_t lane = 0; lane < 8 && !DepthCloud::is_empty(cloud.node(0, b)); ++lane) {
          cloud.remove(b, lane);
        }
        if (random.chance(0.5)) cloud.refit();
      }
      for (std::size_t i = 0; i < all.size(); ++i) {
        move(random, poses[i]);
        const RelativePose pose = relative_pose(poses[i], {});
        expect_agrees(
            all[i], nearest_element(all[i], cloud, scratch, pose, *tracking[i]),
            by_brute_force(all[i], cloud, body, pose),
            std::to_string(seed) + ", " + std::to_string(step) + ", part " + std::to_string(i));
      }
    }
  }
}

TEST(CloudTracking, CarriedBoundsOfBallsHoldOverMotionFramesAndRemovedPoints) {
  const std::vector<ConvexBody> all = parts();
  for (int seed = 0; seed < 2; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 31);
    PointCloud cloud(3000);
    std::vector<std::unique_ptr<CloudTracking>> tracking;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < all.size(); ++i) {
      tracking.push_back(std::make_unique<CloudTracking>());
      poses.push_back(random.pose(1.0));
    }
    for (int step = 0; step < 60; ++step) {
      if (step % 10 == 0) {
        std::vector<MeasuredPoint> points;
        const int count = random.integer(1, 3000);
        const double thickness = random.log_uniform(1e-6, 1.0);
        for (int k = 0; k < count; ++k) {
          Vec3 at = random.in_box(1.5);
          at.z() *= thickness;
          points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                            static_cast<float>(at.z()),
                            static_cast<float>(random.uniform(0.0, 0.01))});
        }
        ASSERT_EQ(cloud.build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
      }
      if (step % 7 == 3 && cloud.size() > 10) {
        const auto b = static_cast<std::size_t>(random.integer(0, int(cloud.blocks()) - 1));
        cloud.remove(b, static_cast<std::size_t>(random.integer(0, 7)));
        if (random.chance(0.5)) cloud.refit();
      }
      for (std::size_t i = 0; i < all.size(); ++i) {
        move(random, poses[i]);
        const RelativePose pose = relative_pose(poses[i], {});
        expect_agrees(
            all[i], nearest_element(all[i], cloud, pose, *tracking[i]),
            by_brute_force(all[i], cloud, pose),
            std::to_string(seed) + ", " + std::to_string(step) + ", part " + std::to_string(i));
      }
    }
  }
}

// Points on a sphere around the part are all nearest within rounding of floats, so every block has
// to be looked at: more than the cut can store.
TEST(CloudTracking, MoreGroupsThanItStoresCostNoTruth) {
  Random random(3);
  std::vector<MeasuredPoint> points;
  for (int k = 0; k < 8 * (int(CloudCut::kSlots) + 150); ++k) {
    const Vec3 at = random.direction();
    points.push_back(
        {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()), 0.0F});
  }
  PointCloud cloud(points.size());
  ASSERT_EQ(cloud.build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  ASSERT_GT(cloud.blocks(), CloudCut::kSlots);
  const ConvexBody part = made(point(Vec3::Zero(), 0.1));
  CloudTracking tracking;
  Pose pose;
  for (int step = 0; step < 40; ++step) {
    const RelativePose at = relative_pose(pose, {});
    expect_agrees(part, nearest_element(part, cloud, at, tracking), by_brute_force(part, cloud, at),
                  std::to_string(step));
    EXPECT_LE(tracking.cut.in_use, CloudCut::kSlots);
    pose.position += 0.01 * random.direction();
  }
  EXPECT_EQ(tracking.cut.count, CloudCut::kSlots);
}

// The tip of a rod passes points that it was far from.
TEST(CloudTracking, CarriedBoundsCountRotation) {
  Random random(4);
  std::vector<MeasuredPoint> points;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 at = random.direction();
    points.push_back(
        {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()), 0.0F});
  }
  PointCloud cloud(points.size());
  ASSERT_EQ(cloud.build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  const ConvexBody part = made(segment(Vec3::Zero(), {0.99, 0, 0}, 0.001));
  CloudTracking tracking;
  for (int step = 0; step < 300; ++step) {
    Pose pose;
    pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.004 * step, Vec3(0, 0.6, 0.8)));
    const RelativePose at = relative_pose(pose, {});
    expect_agrees(part, nearest_element(part, cloud, at, tracking), by_brute_force(part, cloud, at),
                  std::to_string(step));
  }
}

TEST(CloudTracking, OneStateMayServeAnotherPartAndTheOtherKindOfCloud) {
  Random random(5);
  const std::vector<ConvexBody> all = parts();
  const std::vector<float> depth = frame(random, 64, 48);
  DepthCloud slabs(64, 48);
  ASSERT_EQ(
      slabs.build({64, 48, 60.0, 61.0, 32.0, 24.0},
                  {DepthImage::Format::kMetres32, 64, 48, 256, std::as_bytes(std::span(depth))},
                  {0.001, 0.0025}, {0.25, 4.0}),
      DepthBuild::kBuilt);
  std::vector<MeasuredPoint> points(2000, {0.0F, 0.0F, 1.0F, 0.001F});
  for (MeasuredPoint& p : points) p.x = static_cast<float>(random.uniform(-1.0, 1.0));
  PointCloud balls(points.size());
  ASSERT_EQ(balls.build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  ASSERT_EQ(balls.levels(), slabs.levels()) << "else the cut is dropped, and nothing is tried";
  CloudTracking tracking;
  SlabBody body, scratch;
  for (int step = 0; step < 40; ++step) {
    const ConvexBody& part = all[static_cast<std::size_t>(step / 8) % all.size()];
    const RelativePose pose = relative_pose(random.pose(0.5), {});
    const std::string of = std::to_string(step);
    if (random.chance(0.5)) {
      expect_agrees(part, nearest_element(part, slabs, scratch, pose, tracking),
                    by_brute_force(part, slabs, body, pose), of);
    } else {
      expect_agrees(part, nearest_element(part, balls, pose, tracking),
                    by_brute_force(part, balls, pose), of);
    }
  }
}

TEST(CloudTracking, ABodyThatMovesLittleNeedsFewQueriesOfTheCore) {
  Random random(8);
  const std::vector<float> depth = frame(random, 640, 480);
  DepthCloud cloud(640, 480);
  ASSERT_EQ(
      cloud.build({640, 480, 570.0, 570.0, 320.0, 240.0},
                  {DepthImage::Format::kMetres32, 640, 480, 2560, std::as_bytes(std::span(depth))},
                  {0.001, 0.0025}, {0.25, 4.0}),
      DepthBuild::kBuilt);
  const ConvexBody part = made(box({0.05, 0.06, 0.12}));
  CloudTracking tracking;
  SlabBody scratch;
  Pose pose;
  pose.position.z() = 0.5;
  const std::uint32_t cold =
      nearest_element(part, cloud, scratch, relative_pose(pose, {}), tracking).queries;
  std::uint32_t tracked = 0;
  for (int step = 0; step < 50; ++step) {
    pose.position.x() += 1e-4;
    tracked += nearest_element(part, cloud, scratch, relative_pose(pose, {}), tracking).queries;
  }
  EXPECT_LE(tracked, 10 * cold);
}

}  // namespace
}  // namespace clearance::cloud_tracking_test
