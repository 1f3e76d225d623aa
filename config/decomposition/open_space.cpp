// The nearest sample of a cell is its own or that of a neighbour: two sweeps hand samples on (P.-E.
// Danielsson, "Euclidean distance mapping", 1980). Then balls flood in from the border.
#include "config/decomposition/open_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clearance {
namespace {

constexpr double kCells = 1.2e6;      // at most about so many
constexpr double kCellsInBall = 0.4;  // a cell is no smaller than this share of the ball's radius
constexpr double kOnMesh =
    0.9;  // no steps to cells that are nearer to the mesh than this, in cells

}  // namespace

OpenSpace::OpenSpace(const TriangleMesh& mesh, double ball) {
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  const Vec3 wide = box.sizes() + Vec3::Constant(4.0 * ball);
  spacing_ = std::max(kCellsInBall * ball, std::cbrt(wide.prod() / kCells));
  count_ = (wide / spacing_).array().ceil().cast<int>() + 3;
  origin_ = box.center() - 0.5 * spacing_ * (count_ - 1).cast<double>().matrix();
  const std::size_t cells = flat(count_ - 1) + 1;
  nearest_.assign(cells, -1);
  distance_.assign(cells, std::numeric_limits<float>::infinity());
  open_.assign(cells, false);
  sample(mesh);
  spread();
  // A ball smaller than a cell would pass through the mesh.
  flood(std::max(ball, spacing_));
}

template <class Visit>
void OpenSpace::each(const Visit& visit) const {
  Index at;
  for (at.z() = 0; at.z() < count_.z(); ++at.z()) {
    for (at.y() = 0; at.y() < count_.y(); ++at.y()) {
      for (at.x() = 0; at.x() < count_.x(); ++at.x()) visit(at);
    }
  }
}

void OpenSpace::sample(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    subdivide(mesh.triangle(i), spacing_, [&](const Triangle& piece) {
      const auto sample = static_cast<std::int32_t>(samples_.size());
      samples_.push_back((piece[0] + piece[1] + piece[2]) / 3.0);
      offer(index_of(samples_.back()), sample);
    });
  }
}

void OpenSpace::offer(const Index& at, std::int32_t sample) {
  const std::size_t cell = flat(at);
  if (sample < 0 || nearest_[cell] == sample) return;
  const auto distance =
      static_cast<float>((centre(at) - samples_[static_cast<std::size_t>(sample)]).norm());
  if (distance >= distance_[cell]) return;
  distance_[cell] = distance;
  nearest_[cell] = sample;
}

void OpenSpace::spread() {
  const auto sweep = [&](const Index& last, int step) {
    Index at;
    for (int z = 0; z < count_.z(); ++z) {
      for (int y = 0; y < count_.y(); ++y) {
        for (int x = 0; x < count_.x(); ++x) {
          at = step > 0 ? Index(x, y, z) : Index(last - Index(x, y, z));
          for (int axis = 0; axis < 3; ++axis) {
            Index beside = at;
            beside[axis] -= step;
            if (beside[axis] >= 0 && beside[axis] < count_[axis]) offer(at, nearest_[flat(beside)]);
          }
        }
      }
    }
  };
  for (int round = 0; round < 2; ++round) {
    sweep(count_ - 1, 1);
    sweep(count_ - 1, -1);
  }
}

// Floods the cells where the ball's centre can be, then those that the ball covers around them.
// Each step is one cell long and does not cross the mesh.
void OpenSpace::flood(double ball) {
  std::vector<Index> reached = {Index::Zero()}, rim;
  open_[0] = true;
  while (!reached.empty()) {
    const Index at = reached.back();
    reached.pop_back();
    if (spread_open(at, ball, reached)) rim.push_back(at);
  }
  for (int step = 0; step < static_cast<int>(std::ceil(ball / spacing_)); ++step) {
    for (const Index& at : rim) spread_open(at, kOnMesh * spacing_, reached);
    rim.swap(reached);
    reached.clear();
  }
}

// Spreads to neighbours at that distance from the mesh; returns true when there are some nearer.
bool OpenSpace::spread_open(const Index& at, double least, std::vector<Index>& reached) {
  bool is_rim = false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      Index beside = at;
      beside[axis] += step;
      if (beside[axis] < 0 || beside[axis] >= count_[axis] || open_[flat(beside)]) continue;
      if (static_cast<double>(distance_[flat(beside)]) < least) {
        is_rim = true;
        continue;
      }
      open_[flat(beside)] = true;
      reached.push_back(beside);
    }
  }
  return is_rim;
}

std::vector<OpenPoint> OpenSpace::points(double least) const {
  std::vector<OpenPoint> points;
  each([&](const Index& at) {
    const auto distance = static_cast<double>(distance_[flat(at)]);
    if (open_[flat(at)] && distance >= least) points.push_back({centre(at), distance});
  });
  return points;
}

bool OpenSpace::encloses(const Vec3& point) const {
  const Index at = index_of(point);
  if ((at < 0).any() || (at >= count_).any()) return false;
  return !open_[flat(at)];
}

}  // namespace clearance
