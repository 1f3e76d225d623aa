#include "config/decomposition/open_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "config/decomposition/rough_hull.hpp"

namespace clearance {
namespace {

constexpr double kCellsOfBlock = 8.0;  // along each axis

// Tells whether all of the box is outside one of the planes by more than `near`.
bool is_outside(const Eigen::AlignedBox3d& box, std::span<const HalfSpace> hull, double near) {
  const Vec3 middle = box.center(), half = 0.5 * box.sizes();
  return std::ranges::any_of(hull, [&](const HalfSpace& plane) {
    return plane.normal.dot(middle) - plane.normal.cwiseAbs().dot(half) > plane.offset + near;
  });
}

}  // namespace

OpenBlocks::OpenBlocks(std::vector<OpenPoint> points, double spacing) : points_(std::move(points)) {
  const auto block_of = [size = kCellsOfBlock * spacing](const OpenPoint& point) {
    const Vec3 at = (point.position / size).array().floor();
    return std::array{at.x(), at.y(), at.z()};
  };
  std::ranges::stable_sort(points_, std::ranges::greater(), &OpenPoint::distance);
  std::ranges::stable_sort(points_, {}, block_of);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (i == 0 || block_of(points_[i]) != block_of(points_[i - 1])) {
      blocks_.push_back({{}, points_[i].distance, i, i});
    }
    blocks_.back().box.extend(points_[i].position);
    blocks_.back().behind = i + 1;
  }
  std::ranges::stable_sort(blocks_, std::ranges::greater(), &Block::farthest);
}

double OpenBlocks::farthest_in(std::span<const HalfSpace> hull, const Eigen::AlignedBox3d& box,
                               double near) const {
  double most = 0.0;
  for (const Block& block : blocks_) {
    if (block.farthest <= most) break;
    if (!block.box.intersects(box) || is_outside(block.box, hull, near)) continue;
    for (std::size_t i = block.first; i < block.behind && points_[i].distance > most; ++i) {
      if (!box.contains(points_[i].position) || !holds(hull, points_[i].position, near)) continue;
      most = points_[i].distance;
    }
  }
  return most;
}

}  // namespace clearance
