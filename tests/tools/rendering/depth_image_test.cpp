// Depth images of bodies, and the noise that is added to them.
//
// Oracles: rays through every pixel without any culling; the stated bound of the noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"
#include "tools/rendering/depth_renderer.hpp"
#include "tools/rendering/measured_depth.hpp"

namespace clearance::rendering {
namespace {

constexpr PinholeCamera kCamera{
    .width = 96, .height = 64, .fx = 80.0, .fy = 82.0, .cx = 47.3, .cy = 31.1};

std::vector<ConvexBody> shapes() {
  std::vector<ConvexBody> all;
  all.push_back(test::made(point(Vec3::Zero(), 0.3)));
  all.push_back(test::made(segment({0, 0, -0.5}, {0, 0, 0.5}, 0.1)));
  all.push_back(test::made(box({0.4, 0.2, 0.3})));
  all.push_back(test::made(cylinder(0.25, 0.4)));
  all.push_back(test::made(cone(0.3, 0.4)));
  all.push_back(test::made(rounded_by(0.1, test::made(box({0.2, 0.2, 0.1})))));
  all.push_back(test::half_space({0, 0, 1}, -1.5));
  return all;
}

TEST(DepthRenderer, SeesInEachPixelTheNearestBodyOfItsRay) {
  const std::vector<ConvexBody> all = shapes();
  DepthRenderer renderer(kCamera);
  Random random(11);
  std::size_t seen = 0;
  for (int image = 0; image < 12; ++image) {
    const Pose world_from_camera = random.pose(1.0);
    std::vector<PlacedBody> placed;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      placed.push_back({&all[i], i + 1 == all.size() ? Pose() : random.pose(2.0), 10 + i});
    }
    renderer.render(world_from_camera, placed);
    const Eigen::Quaterniond turned = world_from_camera.orientation.conjugate();
    const Pose camera_from_world{turned * -world_from_camera.position, turned};
    std::vector<VisibleBody> bodies;
    for (const PlacedBody& each : placed)
      bodies.emplace_back(*each.shape, compose(camera_from_world, each.world_from_body));
    for (std::size_t pixel = 0; pixel < renderer.depth().size(); ++pixel) {
      const double u = static_cast<double>(pixel % kCamera.width);
      const double v = static_cast<double>(pixel / kCamera.width);
      const Vec3 direction((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1.0);
      double nearest = kInfinity;
      std::uint32_t label = kNoLabel;
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const double t = bodies[i].first_hit(direction);
        if (t == 0.0 || t >= nearest) continue;  // 0: the camera is within
        nearest = t;
        label = placed[i].label;
      }
      const double depth = renderer.depth()[pixel];
      if (nearest == kInfinity || depth == kInfinity) {
        ASSERT_EQ(depth, nearest) << image << " " << pixel;
        continue;
      }
      ++seen;
      ASSERT_NEAR(depth, nearest, 1e-9 * nearest) << image << " " << pixel;
      ASSERT_EQ(renderer.labels()[pixel], label);
      ASSERT_LT((renderer.point(pixel) - depth * direction).norm(), 1e-12 * depth);
    }
  }
  EXPECT_GT(seen, 10'000u);
}

// Returns the depths of an image's pixels; 0 or NaN: missing.
std::vector<double> depths_of(const std::vector<std::byte>& bytes, DepthImage::Format format) {
  std::vector<double> all;
  if (format == DepthImage::Format::kMillimetres16) {
    std::vector<std::uint16_t> pixels(bytes.size() / 2);
    std::memcpy(pixels.data(), bytes.data(), bytes.size());
    for (const std::uint16_t pixel : pixels) all.push_back(0.001 * pixel);
  } else {
    std::vector<float> pixels(bytes.size() / 4);
    std::memcpy(pixels.data(), bytes.data(), bytes.size());
    for (const float pixel : pixels) all.push_back(std::isnan(pixel) ? 0.0 : double{pixel});
  }
  return all;
}

TEST(MeasuredDepth, StaysWithinItsBoundAndUsesIt) {
  constexpr DepthNoise kNoise{.bound = {.constant = 0.001, .quadratic = 0.0025},
                              .range = {.least = 0.3, .greatest = 4.0},
                              .share = 1.0,
                              .missing_share = 0.02,
                              .seed = 5};
  Random random(4);
  std::vector<double> truth;
  for (int i = 0; i < 40000; ++i) truth.push_back(random.uniform(0.2, 4.2));
  truth.push_back(kInfinity);
  for (const auto format : {DepthImage::Format::kMillimetres16, DepthImage::Format::kMetres32}) {
    std::vector<std::byte> bytes, again, next;
    measure(truth, format, kNoise, 3, bytes);
    measure(truth, format, kNoise, 3, again);
    measure(truth, format, kNoise, 4, next);
    EXPECT_EQ(bytes, again);
    EXPECT_NE(bytes, next);
    const std::vector<double> depths = depths_of(bytes, format);
    ASSERT_EQ(depths.size(), truth.size());
    std::size_t missing = 0, in_range = 0;
    double largest = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const bool is_in_range = truth[i] >= 0.3 && truth[i] <= 4.0;
      in_range += is_in_range;
      if (depths[i] == 0.0) {
        missing += is_in_range;
        continue;
      }
      ASSERT_TRUE(is_in_range) << truth[i];
      const double error = std::abs(depths[i] - truth[i]);
      ASSERT_LE(error, kNoise.bound.at(truth[i]));
      ASSERT_LE(error, kNoise.bound.at(depths[i]));
      largest = std::max(largest, error / kNoise.bound.at(truth[i]));
    }
    EXPECT_GT(largest, 0.95);
    EXPECT_NEAR(static_cast<double>(missing) / static_cast<double>(in_range), 0.02, 0.005);
  }
}

TEST(MeasuredDepth, IsMissingWhereTheFormatIsCoarserThanTheBound) {
  constexpr DepthNoise kNoise{.bound = {.constant = 0.0001, .quadratic = 0.0},
                              .range = {.least = 0.3, .greatest = 4.0}};
  std::vector<std::byte> bytes;
  measure(std::vector{1.0005, 1.00005}, DepthImage::Format::kMillimetres16, kNoise, 0, bytes);
  const std::vector<double> depths = depths_of(bytes, DepthImage::Format::kMillimetres16);
  EXPECT_EQ(depths[0], 0.0);
  EXPECT_EQ(depths[1], 1.0);
}

}  // namespace
}  // namespace clearance::rendering
