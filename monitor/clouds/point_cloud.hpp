// The points that a sensor has measured, as balls or cubes, sorted into blocks for the
// nearest-element query.
//
// The union of the balls or cubes is the obstacle. Coordinates stay the float32 numbers of the
// message, in the frame of the sensor, so no distance is rounded to a voxel. A build sorts the
// points along a Morton curve (G. M. Morton, 1966). Blocks of eight neighbours have a box each, and
// so has every group of eight boxes. All memory is allocated by the constructor.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_body.hpp"

namespace clearance {

// Metres, in the frame of the sensor. A coordinate that is not finite means a missing point.
struct MeasuredPoint {
  float x = 0.0F, y = 0.0F, z = 0.0F;
  // The radius of the ball that contains what was measured, or half the side of a cube along the
  // axes of the frame; finite, not negative.
  float radius = 0.0F;
};

enum class ElementShape : std::uint8_t { kBall, kCube };
// A ball around a cube has this times half of the side as its radius, rounded up.
inline constexpr double kCubeRadius = 1.7320508075688774;

// A cube along the axes of its frame.
struct Cube {
  Vec3 centre = Vec3::Zero();
  double half = 0.0;  // of its side, m

  // min n.p over the cube: it is attained at a vertex.
  [[nodiscard]] double least_along(const Vec3& n) const noexcept {
    return n.dot(centre) - half * n.cwiseAbs().sum();
  }
  // The vertex with the least n.p: bit k is set on the upper side of axis k.
  [[nodiscard]] unsigned corner_along(const Vec3& n) const noexcept {
    return (n.x() < 0.0 ? 1U : 0U) | (n.y() < 0.0 ? 2U : 0U) | (n.z() < 0.0 ? 4U : 0U);
  }
  [[nodiscard]] Vec3 vertex(unsigned corner) const noexcept {
    const auto side = [&](unsigned bit) { return (corner & bit) != 0 ? half : -half; };
    return centre + Vec3(side(1U), side(2U), side(4U));
  }
};

// The ball that contains everything which the links can reach, in the frame of the sensor, m.
struct CloudCrop {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

// No crop contains a coordinate larger than this, m.
inline constexpr double kLargestCloudCoordinate = 1e6;

enum class CloudBuild : std::uint8_t {
  kBuilt,
  kTooManyPoints,  // more points within the crop than the capacity
  kBadRadius,      // a radius is negative or not finite, or cubes have too many sizes
  kBadCrop,        // not finite, or beyond kLargestCloudCoordinate
};

class PointCloud {
 public:
  static constexpr std::size_t kFanOut = 8;  // points a block, children a node

  static constexpr std::size_t kMostSizes = 32;  // of cubes

  // A box around the centres of all balls below, and the largest of their radii; or a box around
  // all cubes, and 0.
  struct Node {
    std::array<float, 3> low{}, high{};
    float radius = 0.0F;
  };
  // Eight boxes as vector lanes.
  struct Boxes {
    std::array<std::array<float, kFanOut>, 3> low{}, high{};
    std::array<float, kFanOut> radius{};
  };
  // Eight points as vector lanes. The last block repeats its last point.
  struct Block {
    std::array<float, kFanOut> x{}, y{}, z{}, radius{};
    std::array<std::uint32_t, kFanOut> source{};  // index of the point in the input of build()
    std::uint32_t removed = 0;                    // a bit a lane

    [[nodiscard]] bool is_present(std::size_t lane) const noexcept {
      return (removed >> lane & 1U) == 0;
    }
  };

  // Allocates the memory for this many points within the crop.
  explicit PointCloud(std::size_t capacity);

  // Replaces the cloud by the points whose balls meet the crop. Any other result than kBuilt leaves
  // the previous cloud as it is. Deterministic to the bit; allocates nothing.
  [[nodiscard]] CloudBuild build(std::span<const MeasuredPoint> points,
                                 const CloudCrop& crop) noexcept;
  // The same for cubes. Allocates a body for each size.
  [[nodiscard]] CloudBuild build_cubes(std::span<const MeasuredPoint> cubes, const CloudCrop& crop);

  // Leaves out a point from now on. The boxes above stay as they are, so bounds stay true, but
  // queries look into them in vain until refit(). Returns false for a lane that repeats another
  // one, or that was left out before.
  bool remove(std::size_t block, std::size_t lane) noexcept;
  // Replaces the radius of each element by that of its point, in the order of build()'s input, if
  // that is smaller. The boxes above stay as they are.
  void narrow(std::span<const MeasuredPoint> points) noexcept;
  // Fits all boxes to the points that are left. A box without points has low > high.
  void refit() noexcept;

  [[nodiscard]] static bool is_empty(const Node& node) noexcept {
    return node.low[0] > node.high[0];
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t missing() const noexcept { return missing_; }  // not finite
  [[nodiscard]] std::size_t cropped() const noexcept { return cropped_; }  // outside the crop
  [[nodiscard]] ElementShape shape() const noexcept { return shape_; }
  // The elements of a block and lane, for cubes.
  [[nodiscard]] Cube cube(std::size_t block, std::size_t lane) const noexcept {
    const Block& of = blocks_[block];
    return {{of.x[lane], of.y[lane], of.z[lane]}, of.radius[lane]};
  }
  // A cube of this size at the origin. Requires a cube with it.
  [[nodiscard]] const ConvexBody& cube_at_origin(double half) const noexcept {
    return std::ranges::find(cubes_, half, &SizedCube::half)->body;
  }
  // No centre of a ball, and no vertex of a cube, is farther from the origin of the frame, m.
  [[nodiscard]] double extent() const noexcept { return extent_; }
  // Another number after each build, of any cloud. Copies of a cloud share it.
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

  [[nodiscard]] std::size_t blocks() const noexcept { return levels_ == 0 ? 0 : count_[0]; }
  [[nodiscard]] const Block& block(std::size_t i) const noexcept { return blocks_[i]; }
  // Level 0 has a node a block; the last level has one node. An empty cloud has no level.
  [[nodiscard]] std::size_t levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t nodes(std::size_t level) const noexcept { return count_[level]; }
  [[nodiscard]] Node node(std::size_t level, std::size_t i) const noexcept;
  // The children of a node above level 0. Lanes without a child are empty.
  [[nodiscard]] const Boxes& children(std::size_t level, std::size_t i) const noexcept {
    return boxes_[first_[level - 1] + i];
  }
  // A point at the origin, which queries place at each element.
  [[nodiscard]] const ConvexBody& origin() const noexcept { return origin_; }

 private:
  struct Key {
    std::uint32_t code, source;
  };
  struct SizedCube {
    double half;
    ConvexBody body;
  };
  static constexpr std::size_t kMostLevels = 12;

  [[nodiscard]] CloudBuild build(std::span<const MeasuredPoint> points, const CloudCrop& crop,
                                 ElementShape shape) noexcept;
  [[nodiscard]] Node around(std::size_t block, std::size_t lane) const noexcept;
  void sort() noexcept;
  void fill_blocks(std::span<const MeasuredPoint> points) noexcept;
  void set_node(std::size_t level, std::size_t i, const Node& node) noexcept;
  void add_levels() noexcept;

  std::size_t capacity_;
  std::vector<Key> keys_, sorted_;
  std::vector<Block> blocks_;
  std::vector<Boxes> boxes_;
  std::array<std::size_t, kMostLevels> first_{}, count_{};  // the first group, the nodes, by level
  std::size_t levels_ = 0, built_ = 0, size_ = 0, missing_ = 0, cropped_ = 0;
  double extent_ = 0.0;
  std::uint64_t revision_ = 0;
  ElementShape shape_ = ElementShape::kBall;
  ConvexBody origin_;
  std::vector<SizedCube> cubes_;
};

}  // namespace clearance
