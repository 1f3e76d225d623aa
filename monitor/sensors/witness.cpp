#include "monitor/sensors/witness.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// The depths between which a ray is inside of a body; empty if they do not ascend. A metre of depth
// leads `slope` metres into the surface at `from`; 0: it begins inside.
struct Span {
  double from = 0.0, to = kInfinity;
  double slope = 0.0;
  void begin(double at, double steepness) noexcept {
    if (!(at > from)) return;
    from = at;
    slope = steepness;
  }
  void cut(double at, double rise) noexcept {  // keeps rise * depth <= at
    if (rise > 0.0) {
      to = std::min(to, at / rise);
    } else if (rise < 0.0) {
      begin(at / rise, -rise);
    } else if (at < 0.0) {
      to = -kInfinity;
    }
  }
  [[nodiscard]] bool any() const noexcept { return from < to; }
};

// A ray leads from the camera's origin along (x, y, 1); its parameter is the depth.
Span in_planes(const ConvexBody& body, const Vec3& origin, const Vec3& along,
               double offset) noexcept {
  Span span;
  for (const Facet& facet : body.facets)
    span.cut(facet.offset + offset - facet.normal.dot(origin), facet.normal.dot(along));
  return span;
}

Span in_ball(const Vec3& centre, double radius, const Vec3& origin, const Vec3& along) noexcept {
  const Vec3 from = origin - centre;
  const double a = along.squaredNorm(), b = from.dot(along),
               c = from.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  if (!(radius > 0.0) || !(root > 0.0)) return {.to = -kInfinity};
  Span span{.to = (-b + std::sqrt(root)) / a};
  span.begin((-b - std::sqrt(root)) / a, std::sqrt(root) / radius);
  return span;
}

// Between two planes across the z-axis, and within a cylinder around it.
Span in_cylinder(double low, double high, double radius, const Vec3& origin,
                 const Vec3& along) noexcept {
  Span span;
  span.cut(high - origin.z(), along.z());
  span.cut(origin.z() - low, -along.z());
  const double a = along.x() * along.x() + along.y() * along.y();
  const double b = origin.x() * along.x() + origin.y() * along.y();
  const double c = origin.x() * origin.x() + origin.y() * origin.y() - radius * radius;
  if (!(radius > 0.0) || (a == 0.0 && c > 0.0)) return {.to = -kInfinity};
  if (a == 0.0) return span;
  const double root = b * b - a * c;
  if (!(root > 0.0)) return {.to = -kInfinity};
  span.begin((-b - std::sqrt(root)) / a, std::sqrt(root) / radius);
  span.to = std::min(span.to, (-b + std::sqrt(root)) / a);
  return span;
}

// Where a ray is inside of the body, grown by `offset` (negative: shrunk), or of a body that
// contains it if it is grown, and is contained in it if it is shrunk. Origin and direction are in
// the body's frame.
Span inside(const ConvexBody& body, const Vec3& origin, const Vec3& along, double offset) noexcept {
  if (body.is_curved()) {
    const CurvedShape& shape = body.curved;
    if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
      const auto& [low, high] = shape.discs;
      // A cone is not looked into: how deep a place is in it depends on its slope.
      if (offset < 0.0 && low.radius != high.radius) return {.to = -kInfinity};
      const double radius = std::max(low.radius, high.radius) + body.radius + offset;
      const double more = body.radius + offset;
      return in_cylinder(low.height - more, high.height + more, radius, origin, along);
    }
    const Vec3& axes = shape.semi_axes;
    return in_ball(Vec3::Zero(),
                   (offset > 0.0 ? axes.maxCoeff() : axes.minCoeff()) + body.radius + offset,
                   origin, along);
  }
  if (!body.is_thin()) return in_planes(body, origin, along, body.radius + offset);
  Span span = in_ball(body.anchors.front(), body.radius + offset, origin, along);
  if (body.anchors.size() < 2) return span;
  // A capsule is a ball that moves from one end to the other; a few of them suffice.
  constexpr int kBalls = 8;
  for (int i = 1; i <= kBalls; ++i) {
    const Vec3 centre =
        body.anchors[0] + (static_cast<double>(i) / kBalls) * (body.anchors[1] - body.anchors[0]);
    const Span ball = in_ball(centre, body.radius + offset, origin, along);
    if (!ball.any()) continue;
    span = span.any()
               ? Span{.from = std::min(span.from, ball.from), .to = std::max(span.to, ball.to)}
               : ball;
  }
  return span;
}

// True if inside() without an offset is the body itself, and not one beside it.
bool is_exact(const ConvexBody& body) noexcept {
  if (!body.is_curved()) return !body.is_thin() || body.anchors.size() < 2;
  const CurvedShape& shape = body.curved;
  if (shape.kind == CurvedShape::Kind::kTruncatedCone)
    return shape.discs[0].radius == shape.discs[1].radius;
  return shape.semi_axes.minCoeff() == shape.semi_axes.maxCoeff();
}

// The depth of a pixel, m; NaN: missing.
double depth_at(const DepthImage& image, std::uint32_t column, std::uint32_t row) noexcept {
  const std::byte* const line = image.bytes.data() + row * image.step;
  if (image.format == DepthImage::Format::kMillimetres16) {
    std::uint16_t value = 0;
    std::memcpy(&value, line + column * sizeof(value), sizeof(value));
    return value == 0 ? std::numeric_limits<double>::quiet_NaN() : 1e-3 * value;
  }
  float value = 0.0F;
  std::memcpy(&value, line + column * sizeof(value), sizeof(value));
  return value;
}

}  // namespace

Witness::Witness(const Scene& scene)
    : scene_(scene), errors_(scene), met_(kRays), rays_(scene.robots.size()) {
  residuals_.reserve(kRays);
  std::size_t parts = 0;
  for (const Object& object : scene.objects) parts += object.parts.size();
  placed_.reserve(parts);
}

// Only the rays in the rectangle around a part's sphere can meet it.
Witness::Pixels Witness::pixels_around(const Vec3& centre, double radius,
                                       const PinholeCamera& camera) noexcept {
  const double near = centre.z() - radius, far = centre.z() + radius;
  if (!(near > 0.0)) return {};  // beside or behind the camera: it says nothing
  const auto range = [&](double at, double focal, double middle, std::uint32_t count) {
    const auto pixel = [&](double tangent) {
      return static_cast<std::uint32_t>(
          std::clamp(focal * tangent + middle, 0.0, static_cast<double>(count)));
    };
    const double low = std::min((at - radius) / near, (at - radius) / far);
    const double high = std::max((at + radius) / near, (at + radius) / far);
    return std::pair(pixel(low), std::min(count, pixel(high) + 1));
  };
  const auto [left, right] = range(centre.x(), camera.fx, camera.cx, camera.width);
  const auto [top, bottom] = range(centre.y(), camera.fy, camera.cy, camera.height);
  return {left, right, top, bottom};
}

// The joints at the stamp place the links, and all that may be wrong of a part adds up.
void Witness::place_parts(std::uint32_t r, const Sensor& sensor, const PinholeCamera& camera,
                          const PastPose& place, const PostureHistory& postures) noexcept {
  const std::uint32_t mount = errors_.source_of(sensor.object);
  const double mount_turn = mount == ErrorSource::kNone ? 0.0 : errors_.sources()[mount].rotation;
  const Robot& robot = scene_.robots[r];
  placed_.clear();
  for (std::uint32_t link = 0; link < robot.links.size(); ++link) {
    const std::uint32_t i = robot.links[link].object;
    if (i == RobotLink::kNoObject) continue;
    const PastPose past = postures.link(r, link);
    if (!past.known) continue;
    const Object& object = scene_.objects[i];
    for (const Part& part : object.parts) {
      const double radius = part.shape.bounding_radius + part.shape.radius;
      const double reach = part.object_from_part.position.norm() + radius;
      const Pose world_from_part = compose(past.world_from_body, part.object_from_part);
      const RelativePose camera_from_part = relative_pose(place.world_from_body, world_from_part);
      const double distance = camera_from_part.translation.norm() + radius;
      // The errors of the mount count for this distance, not for the whole picture.
      const double beyond = std::max(0.0, sensor.extent() - distance) * mount_turn;
      const double error =
          rounded_up(place.error(distance) + past.error(reach) + object.mesh_error +
                     object.shape_error + (errors_.largest(i, sensor.object) - beyond));
      const Pixels pixels = pixels_around(camera_from_part.translation, radius + error, camera);
      if (!pixels.is_empty()) placed_.push_back({&part, camera_from_part, error, pixels});
    }
  }
}

// Spreads the rays over the part of the picture in which the robot may be.
void Witness::spread_rays() noexcept {
  Pixels all = placed_.front().pixels;
  for (const Placed& each : placed_) {
    all = {std::min(all.left, each.pixels.left), std::max(all.right, each.pixels.right),
           std::min(all.top, each.pixels.top), std::max(all.bottom, each.pixels.bottom)};
  }
  grid_ = {.left = all.left, .top = all.top};
  const auto rays_of = [&](std::uint32_t pixels) { return (pixels + grid_.step - 1) / grid_.step; };
  while (static_cast<std::uint64_t>(rays_of(all.right - all.left)) * rays_of(all.bottom - all.top) >
         kRays)
    ++grid_.step;
  grid_.columns = rays_of(all.right - all.left);
  grid_.rows = rays_of(all.bottom - all.top);
  const auto rays = static_cast<std::ptrdiff_t>(grid_.columns * grid_.rows);
  std::fill(met_.begin(), met_.begin() + rays, Ray{});
}

void Witness::meet(const Placed& placed, const PinholeCamera& camera) noexcept {
  const ConvexBody& shape = placed.part->shape;
  const bool exact = is_exact(shape);
  const Mat3& turn = placed.camera_from_part.rotation;
  const Vec3 origin = -(turn.transpose() * placed.camera_from_part.translation);
  const auto first = [&](std::uint32_t pixel, std::uint32_t begin) {
    return (pixel - begin) / grid_.step;
  };
  const std::uint32_t right = first(placed.pixels.right - 1, grid_.left) + 1,
                      bottom = first(placed.pixels.bottom - 1, grid_.top) + 1;
  for (std::uint32_t row = first(placed.pixels.top, grid_.top); row < bottom; ++row) {
    for (std::uint32_t column = first(placed.pixels.left, grid_.left); column < right; ++column) {
      const Vec3 ray((grid_.left + column * grid_.step - camera.cx) / camera.fx,
                     (grid_.top + row * grid_.step - camera.cy) / camera.fy, 1.0);
      const Vec3 along = turn.transpose() * ray;
      Ray& met = met_[row * grid_.columns + column];
      const Span grown = inside(shape, origin, along, placed.error);
      if (!grown.any()) continue;
      met.nearest = std::min(met.nearest, static_cast<float>(grown.from));
      // A part that may begin only behind the sure one adds nothing.
      if (!(grown.from < met.surest)) continue;
      const Span stated = exact ? inside(shape, origin, along, 0.0) : Span{.from = grown.from};
      if (stated.any() && stated.from < met.stated) {
        met.stated = static_cast<float>(stated.from);
        met.slope = static_cast<float>(stated.slope);
      }
      const Span shrunk = inside(shape, origin, along, -placed.error);
      if (shrunk.any()) met.surest = std::min(met.surest, static_cast<float>(shrunk.from));
    }
  }
}

RaysOfRobot Witness::count(const Sensor& sensor, const DepthImage& image) noexcept {
  const DepthError error{sensor.error_constant, sensor.error_quadratic};
  RaysOfRobot rays;
  residuals_.clear();
  for (std::uint32_t row = 0; row < grid_.rows; ++row) {
    for (std::uint32_t column = 0; column < grid_.columns; ++column) {
      const Ray& met = met_[row * grid_.columns + column];
      const double surest = met.surest;
      if (!(surest >= sensor.least_depth && surest <= sensor.greatest_depth)) continue;
      const double depth =
          depth_at(image, grid_.left + column * grid_.step, grid_.top + row * grid_.step);
      if (!(depth >= sensor.least_depth && depth <= sensor.greatest_depth)) continue;
      const double by = error.at(depth);
      if (depth > surest + by) {
        ++rays.through;
      } else if (depth >= met.nearest - by) {
        ++rays.agreeing;
        if (met.slope > 0.0F)
          residuals_.push_back(static_cast<float>((depth - met.stated) * met.slope));
      }
    }
  }
  measure(rays);
  return rays;
}

// Selects quantiles of the residuals, which are among them: no sum depends on an order.
void Witness::measure(RaysOfRobot& rays) noexcept {
  if (residuals_.empty()) return;
  const auto at = [&](std::size_t rank) {
    const auto place = residuals_.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(residuals_.begin(), place, residuals_.end());
    return static_cast<double>(*place);
  };
  const std::size_t last = residuals_.size() - 1;
  rays.residual_p50 = at(last / 2);
  for (float& residual : residuals_) residual = std::abs(residual);
  rays.residual_p90 = at(last * 9 / 10);
}

RobotsSeen Witness::judge(const Sensor& sensor, const PinholeCamera& camera,
                          const DepthImage& image, const PastPose& place,
                          const PostureHistory& postures) noexcept {
  RobotsSeen seen;
  const auto robots = std::min<std::size_t>(scene_.robots.size(), kMostRobotsSeen);
  for (std::uint32_t r = 0; r < robots; ++r) {
    rays_[r] = {};
    if (scene_.robots[r].is_attached) continue;
    place_parts(r, sensor, camera, place, postures);
    if (placed_.empty()) continue;
    spread_rays();
    for (const Placed& each : placed_) meet(each, camera);
    rays_[r] = count(sensor, image);
    const std::uint32_t met = rays_[r].agreeing + rays_[r].through;
    if (met < kLeastRays) continue;
    const bool is_through = rays_[r].through > sensor.witness_share * met;
    (is_through ? seen.not_there : seen.there) |= std::uint64_t{1} << r;
  }
  return seen;
}

}  // namespace clearance
