#include "monitor/clouds/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/shapes.hpp"
#include "monitor/clouds/revision.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kCodeBits = 10, kCells = 1U << kCodeBits;  // per axis

// Puts two zero bits between the ten bits of a cell number.
std::uint32_t spread(std::uint32_t v) noexcept {
  v = (v | v << 16) & 0x030000FFU;
  v = (v | v << 8) & 0x0300F00FU;
  v = (v | v << 4) & 0x030C30C3U;
  return (v | v << 2) & 0x09249249U;
}

std::uint32_t cell(double from_low, double scale) noexcept {
  return static_cast<std::uint32_t>(std::clamp(from_low * scale, 0.0, kCells - 1.0));
}

constexpr float kEndless = std::numeric_limits<float>::infinity();
constexpr PointCloud::Node kEmpty{
    {kEndless, kEndless, kEndless}, {-kEndless, -kEndless, -kEndless}, 0.0F};

void include(PointCloud::Node& node, const PointCloud::Node& other) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    node.low[k] = std::min(node.low[k], other.low[k]);
    node.high[k] = std::max(node.high[k], other.high[k]);
  }
  node.radius = std::max(node.radius, other.radius);
}

}  // namespace

PointCloud::PointCloud(std::size_t capacity)
    : capacity_(capacity), origin_(std::get<ConvexBody>(point(Vec3::Zero(), 0.0))) {
  keys_.resize(capacity);
  sorted_.resize(capacity);
  std::size_t nodes = (capacity + kFanOut - 1) / kFanOut, groups = 0;
  blocks_.resize(nodes);
  while (nodes > 0) {
    const std::size_t above = (nodes + kFanOut - 1) / kFanOut;
    groups += above;
    nodes = nodes > 1 ? above : 0;
  }
  boxes_.resize(groups);
}

CloudBuild PointCloud::build(std::span<const MeasuredPoint> points,
                             const CloudCrop& crop) noexcept {
  return build(points, crop, ElementShape::kBall);
}

CloudBuild PointCloud::build_cubes(std::span<const MeasuredPoint> cubes, const CloudCrop& crop) {
  std::vector<SizedCube> sizes;
  for (const MeasuredPoint& cube : cubes) {
    const double half = cube.radius;
    if (!(half >= 0.0 && std::isfinite(half))) return CloudBuild::kBadRadius;
    if (std::ranges::find(sizes, half, &SizedCube::half) != sizes.end()) continue;
    if (sizes.size() == kMostSizes) return CloudBuild::kBadRadius;
    const auto known = std::ranges::find(cubes_, half, &SizedCube::half);
    if (known != cubes_.end()) {
      sizes.push_back(*known);
      continue;
    }
    auto made = half > 0.0 ? box(Vec3::Constant(half)) : point(Vec3::Zero(), 0.0);
    if (!std::holds_alternative<ConvexBody>(made)) return CloudBuild::kBadRadius;
    sizes.push_back({half, std::get<ConvexBody>(std::move(made))});
  }
  const CloudBuild result = build(cubes, crop, ElementShape::kCube);
  if (result == CloudBuild::kBuilt) cubes_.swap(sizes);
  return result;
}

CloudBuild PointCloud::build(std::span<const MeasuredPoint> points, const CloudCrop& crop,
                             ElementShape shape) noexcept {
  // The negated comparisons refuse NaN.
  if (!(crop.radius >= 0.0) ||
      !(crop.centre.array().abs() + crop.radius <= kLargestCloudCoordinate).all()) {
    return CloudBuild::kBadCrop;
  }
  std::size_t kept = 0, missing = 0, cropped = 0;
  double extent2 = 0.0;
  // A cell of the Morton curve is a part of the crop's cube. Cells decide the order alone.
  const Vec3 low = crop.centre - Vec3::Constant(crop.radius);
  const double scale = crop.radius > 0.0 ? kCells / (2.0 * crop.radius) : 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MeasuredPoint& p = points[i];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) {
      ++missing;
      continue;
    }
    if (!(p.radius >= 0.0F && std::isfinite(p.radius))) return CloudBuild::kBadRadius;
    const Vec3 at(p.x, p.y, p.z), from_low = at - low;
    // The rounding of the two sides is far below 2^-40 of either, so no ball that meets the crop is
    // dropped.
    const double radius = shape == ElementShape::kCube ? kCubeRadius * p.radius : p.radius;
    if ((at - crop.centre).norm() > (crop.radius + radius) * (1.0 + 0x1p-40) + 0x1p-30) {
      ++cropped;
      continue;
    }
    if (kept == capacity_) return CloudBuild::kTooManyPoints;
    keys_[kept++] = {spread(cell(from_low.x(), scale)) | spread(cell(from_low.y(), scale)) << 1 |
                         spread(cell(from_low.z(), scale)) << 2,
                     static_cast<std::uint32_t>(i)};
    const double farthest = shape == ElementShape::kCube ? at.norm() + radius : at.norm();
    extent2 = std::max(extent2, farthest * farthest);
  }
  shape_ = shape;
  size_ = built_ = kept;
  missing_ = missing;
  cropped_ = cropped;
  extent_ = std::sqrt(extent2) * (1.0 + 0x1p-50);
  levels_ = 0;
  revision_ = next_revision();
  if (size_ == 0) return CloudBuild::kBuilt;
  sort();
  fill_blocks(points);
  add_levels();
  return CloudBuild::kBuilt;
}

// A stable radix sort: three passes over ten bits each.
void PointCloud::sort() noexcept {
  for (std::uint32_t pass = 0; pass < 3; ++pass) {
    std::array<std::uint32_t, kCells> next{};
    const std::uint32_t shift = pass * kCodeBits;
    for (std::size_t i = 0; i < size_; ++i) ++next[keys_[i].code >> shift & (kCells - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& n : next) {
      const std::uint32_t count = n;
      n = sum;
      sum += count;
    }
    for (std::size_t i = 0; i < size_; ++i) {
      sorted_[next[keys_[i].code >> shift & (kCells - 1)]++] = keys_[i];
    }
    keys_.swap(sorted_);
  }
}

void PointCloud::fill_blocks(std::span<const MeasuredPoint> points) noexcept {
  first_[0] = 0;
  count_[0] = (size_ + kFanOut - 1) / kFanOut;
  for (std::size_t b = 0; b < count_[0]; ++b) {
    Block& block = blocks_[b];
    block.removed = 0;
    Node node = kEmpty;
    for (std::size_t lane = 0; lane < kFanOut; ++lane) {
      const std::uint32_t source = keys_[std::min(b * kFanOut + lane, size_ - 1)].source;
      const MeasuredPoint& p = points[source];
      block.x[lane] = p.x;
      block.y[lane] = p.y;
      block.z[lane] = p.z;
      block.radius[lane] = p.radius;
      block.source[lane] = source;
      include(node, around(b, lane));
    }
    set_node(0, b, node);
  }
}

// The sides of a cube are rounded outward.
PointCloud::Node PointCloud::around(std::size_t block, std::size_t lane) const noexcept {
  const Block& of = blocks_[block];
  Node node{{of.x[lane], of.y[lane], of.z[lane]}, {of.x[lane], of.y[lane], of.z[lane]}, 0.0F};
  if (shape_ == ElementShape::kBall) {
    node.radius = of.radius[lane];
    return node;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    node.low[k] = std::nextafter(node.low[k] - of.radius[lane], -kEndless);
    node.high[k] = std::nextafter(node.high[k] + of.radius[lane], kEndless);
  }
  return node;
}

bool PointCloud::remove(std::size_t block, std::size_t lane) noexcept {
  if (!blocks_[block].is_present(lane)) return false;
  blocks_[block].removed |= 1U << lane;
  if (block * kFanOut + lane >= built_) return false;
  --size_;
  return true;
}

void PointCloud::narrow(std::span<const MeasuredPoint> points) noexcept {
  for (std::size_t b = 0; b < blocks(); ++b) {
    Block& block = blocks_[b];
    for (std::size_t lane = 0; lane < kFanOut; ++lane) {
      const float radius = points[block.source[lane]].radius;
      if (radius < block.radius[lane]) block.radius[lane] = radius;
    }
  }
}

void PointCloud::refit() noexcept {
  if (levels_ == 0) return;
  for (std::size_t b = 0; b < count_[0]; ++b) {
    const Block& block = blocks_[b];
    if (block.removed == 0) continue;
    Node node = kEmpty;
    for (std::size_t lane = 0; lane < kFanOut; ++lane) {
      if (!block.is_present(lane)) continue;
      include(node, around(b, lane));
    }
    set_node(0, b, node);
  }
  add_levels();
}

PointCloud::Node PointCloud::node(std::size_t level, std::size_t i) const noexcept {
  const Boxes& group = boxes_[first_[level] + i / kFanOut];
  Node node;
  for (std::size_t k = 0; k < 3; ++k) {
    node.low[k] = group.low[k][i % kFanOut];
    node.high[k] = group.high[k][i % kFanOut];
  }
  node.radius = group.radius[i % kFanOut];
  return node;
}

void PointCloud::set_node(std::size_t level, std::size_t i, const Node& node) noexcept {
  Boxes& group = boxes_[first_[level] + i / kFanOut];
  for (std::size_t k = 0; k < 3; ++k) {
    group.low[k][i % kFanOut] = node.low[k];
    group.high[k][i % kFanOut] = node.high[k];
  }
  group.radius[i % kFanOut] = node.radius;
}

void PointCloud::add_levels() noexcept {
  for (levels_ = 1;; ++levels_) {
    const std::size_t below = levels_ - 1, groups = (count_[below] + kFanOut - 1) / kFanOut;
    for (std::size_t i = count_[below]; i < groups * kFanOut; ++i) set_node(below, i, kEmpty);
    if (count_[below] == 1) return;
    first_[levels_] = first_[below] + groups;
    count_[levels_] = groups;
    for (std::size_t i = 0; i < groups; ++i) {
      Node node = kEmpty;
      for (std::size_t k = i * kFanOut; k < (i + 1) * kFanOut; ++k)
        include(node, this->node(below, k));
      set_node(levels_, i, node);
    }
  }
}

}  // namespace clearance
