#include "monitor/clouds/plane_bounds.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "monitor/clouds/plane_bounds.cpp"
#include "core/numerics/simd_targets.hpp"
// Keep this order: the targets first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace clearance {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 4>;
using Numbers = hn::Vec<D>;
constexpr D kDoubles;

HWY_INLINE Numbers all(double x) { return hn::Set(kDoubles, x); }
HWY_INLINE Numbers load(const double* from) { return hn::LoadU(kDoubles, from); }
HWY_INLINE Numbers load(const float* from) {
  const hn::Rebind<float, D> floats;
  return hn::PromoteTo(kDoubles, hn::LoadU(floats, from));
}
HWY_INLINE Numbers times(Numbers a, Numbers b) { return hn::Mul(a, b); }
HWY_INLINE Numbers plus(Numbers a, Numbers b) { return hn::Add(a, b); }

// Planes in the frame of the cloud.
struct Planes {
  Numbers x, y, z, offset;
};

// Rotates the normals of a plane a lane: n_cloud = R^T n, offset_cloud = offset - n.t.
class PlaneALane {
 public:
  HWY_INLINE PlaneALane(const PlaneLanes& planes, const RelativePose& pose)
      : planes_(planes), r_(pose.rotation), t_(pose.translation) {}
  HWY_INLINE Planes at(std::size_t lane) const {
    const Numbers x = load(planes_.x.data() + lane), y = load(planes_.y.data() + lane),
                  z = load(planes_.z.data() + lane);
    const auto along = [&](double a, double b, double c) HWY_ATTR {
      return plus(plus(times(all(a), x), times(all(b), y)), times(all(c), z));
    };
    return {along(r_(0, 0), r_(1, 0), r_(2, 0)), along(r_(0, 1), r_(1, 1), r_(2, 1)),
            along(r_(0, 2), r_(1, 2), r_(2, 2)),
            hn::Sub(load(planes_.offset.data() + lane), along(t_.x(), t_.y(), t_.z()))};
  }

 private:
  const PlaneLanes& planes_;
  const Mat3& r_;
  const Vec3& t_;
};

class OnePlane {
 public:
  explicit HWY_INLINE OnePlane(const PartPlane& plane)
      : planes_{all(plane.normal.x()), all(plane.normal.y()), all(plane.normal.z()),
                all(plane.offset)} {}
  HWY_INLINE Planes at(std::size_t) const { return planes_; }

 private:
  Planes planes_;
};

HWY_INLINE Numbers least_of_two(Numbers n, Numbers low, Numbers high) {
  return hn::Min(times(n, low), times(n, high));
}

HWY_INLINE Numbers least_along(const DepthCloud::Lanes& slabs, const Planes& plane,
                               std::size_t lane) {
  const Numbers low = load(slabs.low + lane), high = load(slabs.high + lane);
  const Numbers at_unit_depth =
      plus(plus(least_of_two(plane.x, load(slabs.x0 + lane), load(slabs.x1 + lane)),
                least_of_two(plane.y, load(slabs.y0 + lane), load(slabs.y1 + lane))),
           plane.z);
  return least_of_two(at_unit_depth, low, high);
}
HWY_INLINE hn::Mask<D> is_empty(const DepthCloud::Lanes& slabs, std::size_t lane) {
  return hn::Gt(load(slabs.low + lane), load(slabs.high + lane));
}

HWY_INLINE Numbers least_along(const PointCloud::Boxes& boxes, const Planes& plane,
                               std::size_t lane) {
  const auto axis = [&](Numbers n, std::size_t k) HWY_ATTR {
    return least_of_two(n, load(boxes.low[k].data() + lane), load(boxes.high[k].data() + lane));
  };
  return hn::Sub(plus(plus(axis(plane.x, 0), axis(plane.y, 1)), axis(plane.z, 2)),
                 load(boxes.radius.data() + lane));
}
HWY_INLINE hn::Mask<D> is_empty(const PointCloud::Boxes& boxes, std::size_t lane) {
  return hn::Gt(load(boxes.low[0].data() + lane), load(boxes.high[0].data() + lane));
}

HWY_INLINE Numbers least_along(const PointCloud::Block& points, const Planes& plane,
                               std::size_t lane) {
  return hn::Sub(plus(plus(times(plane.x, load(points.x.data() + lane)),
                           times(plane.y, load(points.y.data() + lane))),
                      times(plane.z, load(points.z.data() + lane))),
                 load(points.radius.data() + lane));
}
HWY_INLINE hn::Mask<D> is_empty(const PointCloud::Block&, std::size_t) {
  return hn::FirstN(kDoubles, 0);
}

HWY_INLINE Numbers least_along(const PlaneBounds::Cubes& cubes, const Planes& plane,
                               std::size_t lane) {
  const PointCloud::Block& of = cubes.block;
  const Numbers sides = plus(plus(hn::Abs(plane.x), hn::Abs(plane.y)), hn::Abs(plane.z));
  return hn::Sub(
      plus(plus(times(plane.x, load(of.x.data() + lane)), times(plane.y, load(of.y.data() + lane))),
           times(plane.z, load(of.z.data() + lane))),
      times(sides, load(of.radius.data() + lane)));
}
HWY_INLINE hn::Mask<D> is_empty(const PlaneBounds::Cubes&, std::size_t) {
  return hn::FirstN(kDoubles, 0);
}

template <class Bodies, class Source>
HWY_INLINE void bounds(const Bodies& bodies, const Source& planes, double error, BoundLanes& out) {
  for (std::size_t lane = 0; lane < kCloudLanes; lane += hn::Lanes(kDoubles)) {
    const Planes plane = planes.at(lane);
    const Numbers bound = hn::Sub(least_along(bodies, plane, lane), plane.offset);
    hn::StoreU(hn::IfThenElse(is_empty(bodies, lane), all(kInfinity), hn::Sub(bound, all(error))),
               kDoubles, out.data() + lane);
  }
}

#define CLEARANCE_BOUNDS(name, Bodies)                                                           \
  void name##_by_lanes(const Bodies& bodies, const PlaneLanes& planes, const RelativePose& pose, \
                       double error, BoundLanes& out) {                                          \
    bounds(bodies, PlaneALane(planes, pose), error, out);                                        \
  }                                                                                              \
  void name##_by_one(const Bodies& bodies, const PartPlane& plane, double error,                 \
                     BoundLanes& out) {                                                          \
    bounds(bodies, OnePlane(plane), error, out);                                                 \
  }
CLEARANCE_BOUNDS(slabs, DepthCloud::Lanes)
CLEARANCE_BOUNDS(boxes, PointCloud::Boxes)
CLEARANCE_BOUNDS(points, PointCloud::Block)
CLEARANCE_BOUNDS(cubes, PlaneBounds::Cubes)
#undef CLEARANCE_BOUNDS

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace clearance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace clearance {

#define CLEARANCE_BOUNDS(name, Bodies)                                                  \
  HWY_EXPORT(name##_by_lanes);                                                          \
  HWY_EXPORT(name##_by_one);                                                            \
  void PlaneBounds::of(const Bodies& bodies, const PlaneLanes& planes, BoundLanes& out) \
      const noexcept {                                                                  \
    HWY_DYNAMIC_DISPATCH(name##_by_lanes)(bodies, planes, part_from_cloud, error, out); \
  }                                                                                     \
  void PlaneBounds::of(const Bodies& bodies, const PartPlane& plane, BoundLanes& out)   \
      const noexcept {                                                                  \
    HWY_DYNAMIC_DISPATCH(name##_by_one)(bodies, plane, error, out);                     \
  }
CLEARANCE_BOUNDS(slabs, DepthCloud::Lanes)
CLEARANCE_BOUNDS(boxes, PointCloud::Boxes)
CLEARANCE_BOUNDS(points, PointCloud::Block)
CLEARANCE_BOUNDS(cubes, PlaneBounds::Cubes)
#undef CLEARANCE_BOUNDS

}  // namespace clearance
#endif
