// Oracle: the slab of each pixel as a polyhedron that the exact factories make of its eight
// vertices, and the core's query of the part and each of them, without planes, tiles or an order.
#include "monitor/clouds/depth_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::depth_cloud_test {
namespace {

using test::made;
using Format = DepthImage::Format;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr DepthError kError{0.001, 0.0025};
constexpr DepthRange kRange{0.25, 4.0};

// An image that owns its bytes. Rows are `padding` bytes longer than their pixels.
struct Picture {
  PinholeCamera camera;
  Format format = Format::kMetres32;
  std::vector<std::byte> bytes;
  std::size_t step = 0;

  [[nodiscard]] DepthImage image() const {
    return {format, camera.width, camera.height, step, bytes};
  }
};

template <class Number>
Picture picture(const PinholeCamera& camera, const std::vector<Number>& pixels,
                std::size_t padding = 0) {
  Picture out;
  out.camera = camera;
  out.format = sizeof(Number) == 2 ? Format::kMillimetres16 : Format::kMetres32;
  out.step = camera.width * sizeof(Number) + padding;
  out.bytes.assign(out.step * camera.height, std::byte{0x5A});
  for (std::size_t v = 0; v < camera.height; ++v) {
    std::memcpy(out.bytes.data() + v * out.step, pixels.data() + v * camera.width,
                camera.width * sizeof(Number));
  }
  return out;
}

PinholeCamera camera(std::uint32_t width, std::uint32_t height) {
  const double focal = 0.9 * std::max(width, height);
  return {width, height, focal, 0.98 * focal, 0.5 * width + 0.4, 0.5 * height - 0.7};
}

// A wall, a step in depth, noise, or few pixels far apart. Some are nearer than the range.
std::vector<float> drawn(Random& random, const PinholeCamera& c) {
  const int kind = random.integer(0, 3);
  const double middle = random.uniform(0.5, 3.0), slope = random.uniform(-0.3, 0.3);
  std::vector<float> pixels;
  for (std::uint32_t v = 0; v < c.height; ++v) {
    for (std::uint32_t u = 0; u < c.width; ++u) {
      double z = middle;
      if (kind == 1) z += slope * u / c.width;
      if (kind == 2) z = u * 2 < c.width ? 0.5 * middle : middle;
      if (kind == 3) z = random.uniform(0.3, 3.5);
      const bool is_missing = random.chance(kind == 3 ? 0.9 : 0.02);
      const float missing = random.chance(0.2) ? -std::numeric_limits<float>::infinity() : kNan;
      pixels.push_back(is_missing ? missing : static_cast<float>(z));
    }
  }
  return pixels;
}

DepthCloud built(const Picture& p) {
  DepthCloud cloud(p.camera.width, p.camera.height);
  EXPECT_EQ(cloud.build(p.camera, p.image(), kError, kRange), DepthBuild::kBuilt);
  return cloud;
}

// Every slab that the cloud has, by the rays of its own columns and rows.
std::vector<ConvexBody> slabs(const DepthCloud& cloud, const PinholeCamera& c) {
  std::vector<ConvexBody> out;
  for (std::size_t b = 0; b < cloud.blocks(); ++b) {
    if (DepthCloud::is_empty(cloud.node(0, b))) continue;
    for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
      const double low = cloud.block(b).low[lane], high = cloud.block(b).high[lane];
      if (low > high) continue;
      const std::uint32_t pixel = cloud.source(b, lane);
      const double u = pixel % c.width, v = pixel / c.width;
      std::vector<Vec3> vertices;
      for (const double x : {(u - 0.5 - c.cx) / c.fx, (u + 0.5 - c.cx) / c.fx}) {
        for (const double y : {(v - 0.5 - c.cy) / c.fy, (v + 0.5 - c.cy) / c.fy}) {
          for (const double z : {low, high}) vertices.emplace_back(x * z, y * z, z);
        }
      }
      out.push_back(made(polyhedron_from_vertices(vertices)));
    }
  }
  return out;
}

NearestElement by_brute_force(const ConvexBody& part, const std::vector<ConvexBody>& slabs,
                              const RelativePose& pose) {
  NearestElement least;
  for (const ConvexBody& slab : slabs) {
    TrackingState state;
    const DistanceResult r = distance(part, slab, pose, state);
    least.lower = std::min(least.lower, r.lower);
    least.upper = std::min(least.upper, r.upper);
  }
  return least;
}

std::vector<ConvexBody> parts() {
  std::vector<ConvexBody> out;
  out.push_back(made(box({0.3, 0.1, 0.05})));
  out.push_back(made(segment({0, 0, -0.2}, {0, 0, 0.2}, 0.07)));
  out.push_back(made(point({0.1, 0, 0}, 0.2)));
  out.push_back(made(hard::facet_ball(4)));
  out.push_back(made(cylinder(0.1, 0.3)));
  out.push_back(made(ellipsoid({0.3, 0.2, 0.1})));
  return out;
}

// Every point of the picture's pyramid within the range is in front of the slab of its pixel, in
// it, or in the unseen cloud, which has nothing else.
TEST(DepthCloud, UnseenPlacesAreThoseBehindSlabsAndInConesOfMissingPixels) {
  int behind = 0, missing = 0;
  for (int seed = 0; seed < 30; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 7919 + 5);
    const PinholeCamera c = camera(static_cast<std::uint32_t>(random.integer(5, 30)),
                                   static_cast<std::uint32_t>(random.integer(3, 20)));
    const std::vector<float> pixels = drawn(random, c);
    const DepthCloud cloud = built(picture(c, pixels));
    DepthCloud unseen(c.width, c.height);
    ASSERT_TRUE(unseen.build_unseen(cloud, kRange));
    SlabBody body;
    CloudTracking tracking;
    const ConvexBody probe = made(point(Vec3::Zero(), 0.0));
    for (int i = 0; i < 200; ++i) {
      const double u = random.uniform(-0.5, c.width - 0.5),
                   v = random.uniform(-0.5, c.height - 0.5);
      const double z = random.uniform(kRange.least, kRange.greatest);
      const Vec3 p((u - c.cx) / c.fx * z, (v - c.cy) / c.fy * z, z);
      const double measured = pixels[static_cast<std::size_t>(std::lround(v)) * c.width +
                                     static_cast<std::size_t>(std::lround(u))];
      const bool is_missing = !(measured >= kRange.least && measured <= kRange.greatest);
      const double end = is_missing ? 0.0 : measured + kError.at(measured);
      if (std::abs(z - end) < 1e-4) continue;
      const NearestElement found = nearest_element(
          probe, unseen, body, relative_pose({p, Eigen::Quaterniond::Identity()}, {}), tracking);
      (is_missing ? missing : behind) += z > end ? 1 : 0;
      if (z > end) {
        EXPECT_LT(found.lower, 1e-9) << seed << " " << i;
      } else {
        EXPECT_GT(found.upper, 1e-9) << seed << " " << i;
      }
    }
    // Without elements that were seen, everything is unseen.
    ASSERT_FALSE(unseen.build_unseen(cloud, {0.0, 4.0}));
  }
  EXPECT_GT(behind, 500);
  EXPECT_GT(missing, 500);
}

TEST(DepthCloud, BoundsAreThoseOfBruteForceForEveryKindOfPart) {
  const std::vector<ConvexBody> all = parts();
  int contacts = 0;
  for (int seed = 0; seed < 40; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 1000003);
    const auto side = [&] { return static_cast<std::uint32_t>(random.integer(1, 19)); };
    const PinholeCamera c = camera(side() + 3, side());
    const DepthCloud cloud = built(picture(c, drawn(random, c)));
    if (cloud.size() == 0) continue;
    const std::vector<ConvexBody> truth_slabs = slabs(cloud, c);
    ASSERT_EQ(truth_slabs.size(), cloud.size());
    SlabBody scratch;
    for (std::size_t i = 0; i < all.size(); ++i) {
      CloudTracking tracking;
      const Pose start = random.pose(1.5), end = random.pose(1.5);
      for (int step = 0; step < 3; ++step) {  // the first is cold, the others are tracked
        const RelativePose pose = relative_pose(test::between(start, end, 0.05 * step), {});
        const NearestElement got = nearest_element(all[i], cloud, scratch, pose, tracking);
        const NearestElement truth = by_brute_force(all[i], truth_slabs, pose);
        const std::string of = "seed " + std::to_string(seed) + ", part " + std::to_string(i) +
                               ", step " + std::to_string(step);
        EXPECT_EQ(got.answer, CloudAnswer::kNearest) << of;
        // The rays of the oracle are rounded anew: its vertices are off by up to 1e-15.
        EXPECT_LE(got.lower, truth.upper + 1e-14) << of;
        EXPECT_GE(got.upper, truth.lower - 1e-14) << of;
        EXPECT_LE(got.upper - got.lower, 1e-9) << of;
        EXPECT_NEAR((got.point_on_element - got.point_on_part).dot(got.normal), got.upper, 2e-9)
            << of;
        contacts += got.upper < 0.0;
      }
    }
  }
  EXPECT_GT(contacts, 20);
}

// The front and back of a slab are across the ray, as two faces of a box with the camera's axes
// are. Its other faces are not those of a box.
TEST(DepthCloud, BoxesAlongTheCamerasAxesHaveTheDepthInTheirSlabs) {
  Random random(12);
  const PinholeCamera c = camera(40, 30);
  const Picture p = picture(c, std::vector<float>(std::size_t{40} * 30, 1.0F));
  const DepthCloud cloud = built(p);
  const std::vector<ConvexBody> truth_slabs = slabs(cloud, c);
  SlabBody scratch;
  int overlapping = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 edges(random.uniform(0.001, 0.1), random.uniform(0.001, 0.1), 0.5);
    const ConvexBody part = made(box(edges));
    const double deep = random.log_uniform(1e-5, 0.02);
    const Vec3 at(random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.2),
                  1.0 - 0.25 - kError.at(1.0) + deep);
    const RelativePose pose = relative_pose({at, Eigen::Quaterniond::Identity()}, {});
    CloudTracking tracking;
    for (int step = 0; step < 2; ++step) {  // cold, and tracked
      const NearestElement got = nearest_element(part, cloud, scratch, pose, tracking);
      const NearestElement truth = by_brute_force(part, truth_slabs, pose);
      EXPECT_LE(got.lower, truth.upper + 1e-14) << i << " " << step;
      EXPECT_GE(got.upper, truth.lower - 1e-14) << i << " " << step;
      overlapping += got.upper < 0.0;
    }
  }
  EXPECT_GT(overlapping, 100);
}

TEST(DepthCloud, SlabsContainTheDepthAndItsErrorAndNoMoreThanTwoFloats) {
  const PinholeCamera c = camera(40, 30);
  std::vector<std::uint16_t> pixels;
  for (std::uint32_t i = 0; i < c.width * c.height; ++i) {
    pixels.push_back(static_cast<std::uint16_t>(200 + 4 * i));
  }
  const DepthCloud cloud = built(picture(c, pixels, 6));
  std::size_t met = 0;
  for (std::size_t b = 0; b < cloud.blocks(); ++b) {
    if (DepthCloud::is_empty(cloud.node(0, b))) continue;
    for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
      const float low = cloud.block(b).low[lane], high = cloud.block(b).high[lane];
      if (low > high) continue;
      const long double z = pixels[cloud.source(b, lane)] / 1000.0L;
      const long double e = 0.001L + 0.0025L * z * z;
      EXPECT_LE(low, z - e);
      EXPECT_GE(high, z + e);
      EXPECT_GE(std::nextafterf(std::nextafterf(low, 9.0F), 9.0F), z - e);
      EXPECT_LE(std::nextafterf(std::nextafterf(high, 0.0F), 0.0F), z + e);
      ++met;
    }
  }
  EXPECT_EQ(met, cloud.size());
  EXPECT_EQ(met, 938U);  // from 250 mm, which is pixel 13 (252 mm), to 4000 mm, which is pixel 950
  EXPECT_EQ(met + cloud.missing(), pixels.size());
}

// REP 117 says so, and a LaserScan has the same rule.
TEST(DepthCloud, MinusInfinityIsSomethingNearerThanTheRangeAndOtherNumbersOutsideAreMissing) {
  const PinholeCamera c = camera(8, 6);
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  const auto size_of = [&](float depth) {
    return built(picture(c, std::vector<float>(48, depth))).size();
  };
  for (const float depth : {kEndless, kNan, 0.0F, -1.0F, 0.2F, 4.1F}) EXPECT_EQ(size_of(depth), 0u);
  std::vector<float> pixels(48, 2.0F);
  pixels[21] = -kEndless;
  const DepthCloud cloud = built(picture(c, pixels));
  EXPECT_EQ(cloud.size(), 48u);
  // Places on the ray of that pixel, up to the range, have no distance from the cloud.
  const Vec3 ray((21 % 8 - c.cx) / c.fx, (21 / 8 - c.cy) / c.fy, 1.0);
  SlabBody scratch;
  for (const double z : {0.001, 0.1, 0.25, 0.251}) {
    CloudTracking tracking;
    const RelativePose pose = relative_pose({}, {});
    const ConvexBody place = made(point(z * ray, 0.0));
    EXPECT_LE(nearest_element(place, cloud, scratch, pose, tracking).lower, 1e-12) << z;
  }
}

TEST(DepthCloud, ImagesOfEverySizeKeepEveryPixelOnce) {
  for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 1}, {4, 2}, {5, 2}, {1, 300}, {300, 1}, {33, 17}, {320, 240}, {240, 320}}) {
    PinholeCamera c{width, height, 400.0, 400.0, 0.5 * width, 0.5 * height};
    const DepthCloud cloud = built(picture(c, std::vector<float>(width * height, 1.5F)));
    std::vector<int> met(width * height);
    for (std::size_t b = 0; b < cloud.blocks(); ++b) {
      if (DepthCloud::is_empty(cloud.node(0, b))) continue;
      for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
        if (cloud.block(b).low[lane] <= cloud.block(b).high[lane]) ++met[cloud.source(b, lane)];
      }
    }
    EXPECT_EQ(met, std::vector<int>(width * height, 1)) << width << " x " << height;
    // The last level spans the image.
    const DepthCloud::Slab all = cloud.slab(cloud.levels() - 1, 0);
    EXPECT_EQ(cloud.nodes(cloud.levels() - 1), 1U);
    EXPECT_EQ(all.x1, (width - 0.5 - c.cx) / c.fx);
    EXPECT_EQ(all.y1, (height - 0.5 - c.cy) / c.fy);
  }
}

TEST(DepthCloud, ARemovedPixelIsNoElementAndAllOfThemLeaveNone) {
  const PinholeCamera c = camera(4, 2);
  DepthCloud cloud = built(picture(c, std::vector<float>{1, 2, 2, 2, 2, 2, 2, 2}));
  SlabBody scratch;
  const RelativePose pose;
  CloudTracking tracking;
  const ConvexBody part = made(point(Vec3::Zero(), 0.1));
  const double before = nearest_element(part, cloud, scratch, pose, tracking).upper;
  EXPECT_LT(before, 1.2);
  cloud.remove(0, 0);
  cloud.remove(0, 0);
  EXPECT_EQ(cloud.size(), 7U);
  EXPECT_GT(nearest_element(part, cloud, scratch, pose, tracking).lower, 1.8);
  for (std::size_t lane = 1; lane < 8; ++lane) cloud.remove(0, lane);
  EXPECT_EQ(nearest_element(part, cloud, scratch, pose, tracking).answer, CloudAnswer::kEmpty);
}

TEST(DepthCloud, AllocatesNothingAndRepeatsToTheBit) {
  Random random(9);
  const PinholeCamera c = camera(160, 120);
  const Picture p = picture(c, drawn(random, c)), other = picture(c, drawn(random, c));
  DepthCloud first(160, 120), second(160, 120);
  SlabBody scratch;
  const ConvexBody part = made(box({0.3, 0.1, 0.05}));
  const RelativePose pose = relative_pose(random.pose(1.0), {});
  CloudTracking one, two;
  const std::uint64_t before = allocations();
  const DepthBuild build = first.build(c, p.image(), kError, kRange);
  const NearestElement a = nearest_element(part, first, scratch, pose, one);
  EXPECT_EQ(allocations(), before);
  ASSERT_EQ(build, DepthBuild::kBuilt);
  ASSERT_EQ(second.build(c, other.image(), kError, kRange), DepthBuild::kBuilt);
  ASSERT_EQ(second.build(c, p.image(), kError, kRange), DepthBuild::kBuilt);
  const NearestElement b = nearest_element(part, second, scratch, pose, two);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.point_on_part, b.point_on_part);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.queries, b.queries);
}

TEST(DepthCloud, RefusesWhatIsNoImageOfTheCameraAndKeepsTheFormerOne) {
  const PinholeCamera c = camera(8, 4);
  const Picture good = picture(c, std::vector<float>(32, 1.0F));
  DepthCloud cloud(8, 4);
  ASSERT_EQ(cloud.build(c, good.image(), kError, kRange), DepthBuild::kBuilt);
  const auto refused = [&](PinholeCamera with, const DepthImage& image, const DepthError& error,
                           const DepthRange& range) {
    const DepthBuild result = cloud.build(with, image, error, range);
    EXPECT_EQ(cloud.size(), 32U);
    return result;
  };
  DepthImage image = good.image();
  image.width = 9;
  EXPECT_EQ(refused(c, image, kError, kRange), DepthBuild::kWrongSize);
  const Picture large = picture(camera(16, 4), std::vector<float>(64, 1.0F));
  EXPECT_EQ(refused(large.camera, large.image(), kError, kRange), DepthBuild::kWrongSize);
  image = good.image();
  image.step = 0;
  EXPECT_EQ(refused(c, image, kError, kRange), DepthBuild::kShortImage);
  image = good.image();
  image.bytes = image.bytes.first(image.bytes.size() - 1);
  EXPECT_EQ(refused(c, image, kError, kRange), DepthBuild::kShortImage);
  image = good.image();
  image.step = std::numeric_limits<std::size_t>::max();
  EXPECT_EQ(refused(c, image, kError, kRange), DepthBuild::kShortImage);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e-3}) {
    PinholeCamera wrong = c;
    wrong.fx = bad;
    EXPECT_EQ(refused(wrong, good.image(), kError, kRange), DepthBuild::kBadCamera) << bad;
  }
  EXPECT_EQ(refused(c, good.image(), kError, {0.0, 4.0}), DepthBuild::kBadRange);
  EXPECT_EQ(refused(c, good.image(), kError, {2.0, 1.0}), DepthBuild::kBadRange);
  EXPECT_EQ(refused(c, good.image(), {0.5, 0.0}, kRange), DepthBuild::kBadRange);
  EXPECT_EQ(refused(c, good.image(), {kNan, 0.0}, kRange), DepthBuild::kBadRange);
}

}  // namespace
}  // namespace clearance::depth_cloud_test
