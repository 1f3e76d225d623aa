// The elements of either kind of cloud, as the search for the nearest one reads them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/distance.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/clouds/plane_bounds.hpp"
#include "monitor/clouds/point_cloud.hpp"
#include "monitor/clouds/slab_body.hpp"

namespace clearance {

// Lengths that are computed here are at most this factor too small.
inline constexpr double kLengthRoundedUp = 1.0 + 0x1p-40;

// The vertex of a small body is mostly its nearest point, or its deepest one. Then a query of that
// point answers: its distance is an upper bound for the body, its plane gives a lower one, and the
// two agree, or the body is left out. Returns false if a query of the body itself has to answer.
template <class Body, class Search>
[[nodiscard]] bool query_vertex(const Body& body, const Vec3& along, Search& search,
                                DistanceResult& r) noexcept {
  // The bounds of a body by its vertex differ by rounding, or the vertex is not the nearest point,
  // m.
  constexpr double kTightVertex = 1e-10;
  unsigned corner = body.corner_along(search.in_cloud(along));
  for (int i = 0; i < 3; ++i) {
    r = search.query(body.vertex(corner), {});
    if (!search.has_plane()) return false;
    const Vec3 n = search.in_cloud(r.normal);
    r.lower = std::min(r.lower, search.bound_by_newest(body.least_along(n)));
    if (r.upper - r.lower <= kTightVertex || search.is_left_out(r.lower)) return true;
    const unsigned next = body.corner_along(n);
    if (next == corner) return false;
    corner = next;
  }
  return false;
}

// The points of a PointCloud, whatever is around them.
class CentredElements {
 public:
  explicit CentredElements(const PointCloud& cloud) noexcept : cloud_(cloud) {}

  [[nodiscard]] const PointCloud& cloud() const noexcept { return cloud_; }
  [[nodiscard]] const ConvexBody& origin() const noexcept { return cloud_.origin(); }
  [[nodiscard]] bool is_empty(std::size_t level, std::size_t i) const noexcept {
    return i >= cloud_.nodes(level) || PointCloud::is_empty(cloud_.node(level, i));
  }
  [[nodiscard]] bool is_present(std::size_t b, std::size_t lane) const noexcept {
    return cloud_.block(b).is_present(lane);
  }
  [[nodiscard]] std::uint32_t source(std::size_t b, std::size_t lane) const noexcept {
    return cloud_.block(b).source[lane];
  }

  // A point of the node's box that is near `a`.
  [[nodiscard]] Vec3 towards(std::size_t level, std::size_t i, const Vec3& a) const noexcept {
    const PointCloud::Node node = cloud_.node(level, i);
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      p[k] = std::clamp(a[k], double{node.low[axis]}, double{node.high[axis]});
    }
    return p;
  }
  // No element below the node has a point farther from c, m.
  [[nodiscard]] double farthest(std::size_t level, std::size_t i, const Vec3& c) const noexcept {
    const PointCloud::Node node = cloud_.node(level, i);
    double squared = 0.0;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const double along =
          std::max(std::abs(node.low[axis] - c[k]), std::abs(node.high[axis] - c[k]));
      squared += along * along;
    }
    return (std::sqrt(squared) + node.radius) * kLengthRoundedUp;
  }

 protected:
  template <class Bodies, class Planes>
  void bound_with(const Bodies& bodies, std::size_t level, std::size_t i, const Planes& planes,
                  const PlaneBounds& by, BoundLanes& out) const noexcept {
    if (level > 0) {
      by.of(cloud_.children(level, i), planes, out);
      return;
    }
    const PointCloud::Block& block = cloud_.block(i);
    by.of(bodies, planes, out);
    for (std::size_t k = 0; block.removed != 0 && k < out.size(); ++k) {
      if (!block.is_present(k)) out[k] = kInfinity;
    }
  }

  const PointCloud& cloud_;
};

class Balls : public CentredElements {
 public:
  using CentredElements::CentredElements;

  // The bounds of the eight children of a node, or of the elements of a block for level 0.
  template <class Planes>
  void bound(std::size_t level, std::size_t i, const Planes& planes, const PlaneBounds& by,
             BoundLanes& out) const noexcept {
    bound_with(cloud_.block(level > 0 ? 0 : i), level, i, planes, by, out);
  }

  // A ball's signed distance is that of its centre less its radius.
  template <class Search>
  [[nodiscard]] DistanceResult evaluate(std::size_t b, std::size_t lane, const Vec3&,
                                        Search& search) const noexcept {
    const PointCloud::Block& block = cloud_.block(b);
    const double radius = block.radius[lane];
    DistanceResult r = search.query({block.x[lane], block.y[lane], block.z[lane]}, {});
    r.lower = outward(r.lower - radius, -1.0);
    r.upper = outward(r.upper - radius, 1.0);
    r.point_on_b -= radius * r.normal;
    return r;
  }

 private:
  static double outward(double x, double sign) noexcept { return x + sign * 0x1p-52 * std::abs(x); }
};

class Cubes : public CentredElements {
 public:
  using CentredElements::CentredElements;

  template <class Planes>
  void bound(std::size_t level, std::size_t i, const Planes& planes, const PlaneBounds& by,
             BoundLanes& out) const noexcept {
    bound_with(PlaneBounds::Cubes{cloud_.block(level > 0 ? 0 : i)}, level, i, planes, by, out);
  }

  template <class Search>
  [[nodiscard]] DistanceResult evaluate(std::size_t b, std::size_t lane, const Vec3& along,
                                        Search& search) const noexcept {
    const Cube cube = cloud_.cube(b, lane);
    DistanceResult r;
    if (query_vertex(cube, along, search, r)) return r;
    return search.query(cloud_.cube_at_origin(cube.half), cube.centre, cube);
  }
};

// The slabs of a DepthCloud.
class Slabs {
 public:
  Slabs(const DepthCloud& cloud, SlabBody& body) noexcept : cloud_(cloud), body_(body) {}

  [[nodiscard]] const DepthCloud& cloud() const noexcept { return cloud_; }
  [[nodiscard]] const ConvexBody& origin() const noexcept { return body_.origin(); }
  [[nodiscard]] bool is_empty(std::size_t level, std::size_t i) const noexcept {
    return i >= cloud_.nodes(level) || DepthCloud::is_empty(cloud_.node(level, i));
  }
  [[nodiscard]] bool is_present(std::size_t b, std::size_t lane) const noexcept {
    return !is_empty(0, b) && cloud_.block(b).low[lane] <= cloud_.block(b).high[lane];
  }
  [[nodiscard]] std::uint32_t source(std::size_t b, std::size_t lane) const noexcept {
    return cloud_.source(b, lane);
  }

  template <class Planes>
  void bound(std::size_t level, std::size_t i, const Planes& planes, const PlaneBounds& by,
             BoundLanes& out) const noexcept {
    by.of(cloud_.lanes(level, i), planes, out);
  }
  [[nodiscard]] Vec3 towards(std::size_t level, std::size_t i, const Vec3& a) const noexcept {
    const DepthCloud::Slab slab = cloud_.slab(level, i);
    const double z = std::clamp(a.z(), slab.low, slab.high);
    return {std::clamp(a.x(), slab.x0 * z, slab.x1 * z),
            std::clamp(a.y(), slab.y0 * z, slab.y1 * z), z};
  }
  [[nodiscard]] double farthest(std::size_t level, std::size_t i, const Vec3& c) const noexcept {
    const DepthCloud::Slab slab = cloud_.slab(level, i);
    const auto widest = [](double x0, double x1, double z0, double z1, double at) {
      const double low = std::min(x0 * z0, x0 * z1), high = std::max(x1 * z0, x1 * z1);
      return std::max(std::abs(low - at), std::abs(high - at));
    };
    const double x = widest(slab.x0, slab.x1, slab.low, slab.high, c.x());
    const double y = widest(slab.y0, slab.y1, slab.low, slab.high, c.y());
    const double z = std::max(std::abs(slab.low - c.z()), std::abs(slab.high - c.z()));
    return std::sqrt(x * x + y * y + z * z) * kLengthRoundedUp;
  }

  template <class Search>
  [[nodiscard]] DistanceResult evaluate(std::size_t b, std::size_t lane, const Vec3& along,
                                        Search& search) const noexcept {
    const DepthCloud::Slab slab = cloud_.pixel_slab(b, lane);
    DistanceResult r;
    if (query_vertex(slab, along, search, r)) return r;
    return search.query(body_.of(slab), Vec3::Zero(), slab);
  }

 private:
  const DepthCloud& cloud_;
  SlabBody& body_;
};

}  // namespace clearance
