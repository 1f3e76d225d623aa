// Many parts and clouds against every single element, without planes, trees or queries of the core.
//
// Oracle: closed forms of the distance of a point from a box, a capsule and a ball. A ball's
// distance is exact by them. Points of slabs and cubes (vertices, and the one that is nearest to
// the part's middle) bound their distance from above; witness points that lie in both bodies bound
// it from below.
//
// CLEARANCE_CLOUD_PAIRS is the number of pairs of a part and an element, CLEARANCE_CLOUD_SEED the
// seed of the first cloud: shards take seeds that are 1,000,000 apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::cloud_campaign_test {
namespace {

using test::made;

constexpr double kRounding = 1e-11;  // m: of the closed forms, for lengths below 10 m

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

// A part by its closed form, at the origin.
struct SimplePart {
  Vec3 half = Vec3::Zero();  // of a box
  double along = 0.0;        // half of a capsule's axis, along z
  double radius = 0.0;       // of a capsule or a ball

  [[nodiscard]] bool is_box() const { return radius == 0.0; }
  [[nodiscard]] ConvexBody body() const {
    if (is_box()) return made(box(half));
    return along == 0.0 ? made(point(Vec3::Zero(), radius))
                        : made(segment({0, 0, -along}, {0, 0, along}, radius));
  }
  // Signed: inside, minus the distance from the surface.
  [[nodiscard]] double distance_to(const Vec3& p) const {
    if (is_box()) {
      const double x = std::abs(p.x()) - half.x(), y = std::abs(p.y()) - half.y(),
                   z = std::abs(p.z()) - half.z();
      const double most = std::max({x, y, z});
      if (most <= 0.0) return most;
      const double ox = std::max(x, 0.0), oy = std::max(y, 0.0), oz = std::max(z, 0.0);
      return std::sqrt(ox * ox + oy * oy + oz * oz);
    }
    const double z = p.z() - std::clamp(p.z(), -along, along);
    return std::sqrt(p.x() * p.x() + p.y() * p.y() + z * z) - radius;
  }
};

SimplePart drawn_part(Random& random) {
  SimplePart part;
  switch (random.integer(0, 2)) {
    case 0:
      for (int k = 0; k < 3; ++k) part.half[k] = random.log_uniform(0.005, 0.4);
      break;
    case 1:
      part.along = random.log_uniform(0.01, 0.5);
      [[fallthrough]];
    default:
      part.radius = random.log_uniform(0.005, 0.3);
  }
  return part;
}

class Campaign {
 public:
  explicit Campaign(std::uint64_t seed) : random_(seed) {}

  // One cloud, several parts, each tracked along a motion.
  void run() {
    switch (random_.integer(0, 2)) {
      case 0:
        return run_balls();
      case 1:
        return run_slabs();
      default:
        return run_cubes();
    }
  }
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }
  [[nodiscard]] std::uint64_t contacts() const { return contacts_; }
  [[nodiscard]] std::uint64_t wrong() const { return wrong_; }
  [[nodiscard]] std::uint64_t loose() const { return loose_; }

 private:
  std::vector<MeasuredPoint> drawn_points(bool on_grid) {
    std::vector<MeasuredPoint> points;
    const int count = static_cast<int>(random_.log_uniform(1.0, 3000.0));
    const double spread = random_.log_uniform(0.01, 1.5);
    const bool flat = random_.chance(0.3);
    const float side = static_cast<float>(random_.log_uniform(0.01, 0.1));
    for (int i = 0; i < count; ++i) {
      const Vec3 p = random_.in_box(spread);
      const auto at = [&](double x) {
        return on_grid ? side * (std::floor(static_cast<float>(x) / side) + 0.5F)
                       : static_cast<float>(x);
      };
      points.push_back(
          {at(p.x()), at(p.y()), flat ? 1.0F : at(p.z()) + 1.0F,
           on_grid ? 0.5F * side : static_cast<float>(random_.log_uniform(1e-4, 0.03))});
    }
    return points;
  }

  // Calls check(part, pose, found) for parts along motions. `ask` queries the cloud.
  template <class Ask, class Check>
  void motions(const Ask& ask, const Check& check) {
    for (int parts = 0; parts < 4; ++parts) {
      const SimplePart part = drawn_part(random_);
      const ConvexBody body = part.body();
      CloudTracking tracking;
      Pose place = random_.pose(0.6);
      place.position.z() += 1.0;
      const Vec3 step = random_.log_uniform(1e-5, 0.05) * random_.direction();
      const Eigen::Quaterniond turn(
          Eigen::AngleAxisd(random_.log_uniform(1e-6, 0.2), random_.direction()));
      for (int query = 0; query < 6; ++query) {
        const RelativePose pose = relative_pose(place, {});
        const NearestElement found = ask(body, pose, tracking);
        if (found.answer != CloudAnswer::kNearest) {
          ++wrong_;
          ADD_FAILURE() << "no answer";
          return;
        }
        loose_ += found.upper - found.lower > 1e-9 ? 1 : 0;
        contacts_ += found.upper < 0.0 ? 1 : 0;
        if (!check(part, pose, found)) ++wrong_;
        place.position += step;
        place.orientation = (turn * place.orientation).normalized();
      }
    }
  }

  // The witness points lie on the part and in the element, and are `upper` apart.
  static bool has_witness(const SimplePart& part, const NearestElement& found, bool in_element) {
    if (found.upper < 0.0) return true;
    const double gap = (found.point_on_element - found.point_on_part).norm();
    return in_element && gap <= found.upper + kRounding &&
           part.distance_to(found.point_on_part) <= 1e-9;
  }

  void run_balls() {
    const std::vector<MeasuredPoint> points = drawn_points(false);
    PointCloud cloud(points.size());
    ASSERT_EQ(cloud.build(points, {{0, 0, 1}, 100.0}), CloudBuild::kBuilt);
    motions([&](const ConvexBody& body, const RelativePose& pose,
                CloudTracking& tracking) { return nearest_element(body, cloud, pose, tracking); },
            [&](const SimplePart& part, const RelativePose& pose, const NearestElement& found) {
              double least = kInfinity;
              for (const MeasuredPoint& p : points) {
                const Vec3 at = pose.rotation * Vec3(p.x, p.y, p.z) + pose.translation;
                least = std::min(least, part.distance_to(at) - double{p.radius});
              }
              pairs_ += points.size();
              const bool holds =
                  found.lower <= least + kRounding && found.upper >= least - kRounding;
              EXPECT_TRUE(holds) << found.lower << " " << least << " " << found.upper;
              return holds;
            });
  }

  // Compares `lower` with points of an element, and counts it as a pair.
  template <class Element>
  void lower_by(const Element& element, const Vec3& middle, const SimplePart& part,
                const RelativePose& pose, double& least) {
    for (unsigned corner = 0; corner < 8; ++corner)
      least = std::min(least,
                       part.distance_to(pose.rotation * element.vertex(corner) + pose.translation));
    least = std::min(least, part.distance_to(pose.rotation * middle + pose.translation));
    ++pairs_;
  }

  void run_slabs() {
    const auto columns = static_cast<std::uint32_t>(random_.log_uniform(3.0, 64.0));
    const auto rows = static_cast<std::uint32_t>(random_.log_uniform(2.0, 48.0));
    const double focal = std::max(columns, rows) * random_.uniform(0.7, 4.0);
    const PinholeCamera camera{columns,
                               rows,
                               focal,
                               focal * random_.uniform(0.9, 1.1),
                               0.5 * columns + random_.uniform(-0.5, 0.5),
                               0.5 * rows + random_.uniform(-0.5, 0.5)};
    const double base = random_.uniform(0.4, 2.0), rough = random_.log_uniform(1e-4, 1.0);
    std::vector<float> depth;
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
      const bool is_missing = random_.chance(0.05);
      depth.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN()
                                 : static_cast<float>(base + rough * random_.unit()));
    }
    const DepthImage image{DepthImage::Format::kMetres32, columns, rows, columns * 4,
                           std::as_bytes(std::span(depth))};
    DepthCloud cloud(columns, rows);
    const DepthError error{random_.log_uniform(1e-5, 0.01), random_.log_uniform(1e-5, 0.01)};
    ASSERT_EQ(cloud.build(camera, image, error, {0.3, 4.0}), DepthBuild::kBuilt);
    if (cloud.size() == 0) return;
    std::vector<DepthCloud::Slab> slabs;
    std::vector<std::uint32_t> sources;
    for (std::size_t b = 0; b < cloud.blocks(); ++b) {
      if (DepthCloud::is_empty(cloud.node(0, b))) continue;
      for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
        if (cloud.block(b).low[lane] > cloud.block(b).high[lane]) continue;
        slabs.push_back(cloud.pixel_slab(b, lane));
        sources.push_back(cloud.source(b, lane));
      }
    }
    SlabBody scratch;
    motions(
        [&](const ConvexBody& body, const RelativePose& pose, CloudTracking& tracking) {
          return nearest_element(body, cloud, scratch, pose, tracking);
        },
        [&](const SimplePart& part, const RelativePose& pose, const NearestElement& found) {
          double least = kInfinity;
          const Vec3 middle = pose.rotation.transpose() * -pose.translation;
          const Vec3 witness =
              pose.rotation.transpose() * (found.point_on_element - pose.translation);
          bool in_element = false;
          for (std::size_t i = 0; i < slabs.size(); ++i) {
            const DepthCloud::Slab& s = slabs[i];
            const double z = std::clamp(middle.z(), s.low, s.high);
            lower_by(s,
                     {std::clamp(middle.x(), s.x0 * z, s.x1 * z),
                      std::clamp(middle.y(), s.y0 * z, s.y1 * z), z},
                     part, pose, least);
            if (sources[i] != found.source) continue;
            const Vec3& w = witness;
            in_element = w.z() >= s.low - 1e-9 && w.z() <= s.high + 1e-9 &&
                         w.x() >= s.x0 * w.z() - 1e-9 && w.x() <= s.x1 * w.z() + 1e-9 &&
                         w.y() >= s.y0 * w.z() - 1e-9 && w.y() <= s.y1 * w.z() + 1e-9;
          }
          const bool holds =
              found.lower <= least + kRounding && has_witness(part, found, in_element);
          EXPECT_TRUE(holds) << found.lower << " " << least << " " << in_element;
          return holds;
        });
  }

  void run_cubes() {
    const std::vector<MeasuredPoint> cubes = drawn_points(true);
    PointCloud cloud(cubes.size());
    ASSERT_EQ(cloud.build_cubes(cubes, {{0, 0, 1}, 100.0}), CloudBuild::kBuilt);
    motions([&](const ConvexBody& body, const RelativePose& pose,
                CloudTracking& tracking) { return nearest_element(body, cloud, pose, tracking); },
            [&](const SimplePart& part, const RelativePose& pose, const NearestElement& found) {
              double least = kInfinity;
              const Vec3 middle = pose.rotation.transpose() * -pose.translation;
              for (const MeasuredPoint& p : cubes) {
                const Cube cube{{p.x, p.y, p.z}, p.radius};
                const Vec3 near =
                    cube.centre + (middle - cube.centre).cwiseMax(-cube.half).cwiseMin(cube.half);
                lower_by(cube, near, part, pose, least);
              }
              const MeasuredPoint& p = cubes[found.source];
              const Vec3 witness =
                  pose.rotation.transpose() * (found.point_on_element - pose.translation);
              const bool in_element =
                  (witness - Vec3(p.x, p.y, p.z)).cwiseAbs().maxCoeff() <= p.radius + 1e-9;
              const bool holds =
                  found.lower <= least + kRounding && has_witness(part, found, in_element);
              EXPECT_TRUE(holds) << found.lower << " " << least << " " << in_element;
              return holds;
            });
  }

  Random random_;
  std::uint64_t pairs_ = 0, contacts_ = 0, wrong_ = 0, loose_ = 0;
};

TEST(CloudCampaign, NoBoundIsWrongForAnyElement) {
  const std::uint64_t wanted = from_environment("CLEARANCE_CLOUD_PAIRS", 2'000'000);
  std::uint64_t seed = from_environment("CLEARANCE_CLOUD_SEED", 1);
  std::uint64_t pairs = 0, contacts = 0, wrong = 0, loose = 0, clouds = 0;
  for (; pairs < wanted && wrong < 10; seed += 101) {
    SCOPED_TRACE(seed);
    Campaign campaign(seed);
    campaign.run();
    pairs += campaign.pairs();
    contacts += campaign.contacts();
    wrong += campaign.wrong();
    loose += campaign.loose();
    ++clouds;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(loose, 0u) << "bounds differ by more than 1e-9 m";
  EXPECT_GT(contacts, clouds / 10);
  RecordProperty("pairs", std::to_string(pairs));
  RecordProperty("clouds", std::to_string(clouds));
  RecordProperty("contacts", std::to_string(contacts));
}

}  // namespace
}  // namespace clearance::cloud_campaign_test
