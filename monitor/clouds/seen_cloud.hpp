// The content of one frame of a sensor, a depth image or points, behind one query.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "monitor/clouds/nearest_element.hpp"
#include "monitor/clouds/own_points.hpp"

namespace clearance {

// Places that a frame cannot show, near a body whose own image was left out, at the frame's stamp.
struct HiddenNear {
  std::uint32_t object = 0;  // the caller's number of the body
  // The shell's thickness includes the error of the body's pose: anything that close to the exact
  // body may be left out.
  BlindShell shell;
  // A lower bound of the distance to the nearest unseen place, and about where it is, in the world,
  // m. -infinity and NaN: not known.
  double unseen = -kInfinity;
  Vec3 unseen_at = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

// All memory is allocated at the start. It is built by one thread, and may then be read by any.
class SeenCloud {
 public:
  static constexpr std::uint32_t kNoObject = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] static SeenCloud of_images(std::uint32_t most_columns, std::uint32_t most_rows) {
    return SeenCloud(DepthCloud(most_columns, most_rows));
  }
  [[nodiscard]] static SeenCloud of_points(std::size_t most) { return SeenCloud(PointCloud(most)); }

  // Null if it is of the other kind.
  [[nodiscard]] DepthCloud* depth() noexcept { return std::get_if<DepthCloud>(&cloud_); }
  [[nodiscard]] const DepthCloud* depth() const noexcept {
    return std::get_if<DepthCloud>(&cloud_);
  }
  [[nodiscard]] PointCloud* points() noexcept { return std::get_if<PointCloud>(&cloud_); }
  [[nodiscard]] const PointCloud* points() const noexcept {
    return std::get_if<PointCloud>(&cloud_);
  }
  // Elements that queries meet.
  [[nodiscard]] std::size_t size() const noexcept {
    return depth() != nullptr ? depth()->size() : points()->size();
  }
  // Returns whether the frame shows that a place without elements is clear. An empty cloud shows it
  // only if the caller has noted enough of known bodies at their places.
  [[nodiscard]] bool shows_place() const noexcept { return size() > 0 || shows_known_; }
  void note_known(bool shows_known) noexcept { shows_known_ = shows_known; }

  // `body` is scratch memory of the caller. Without elements, the answer is kEmpty, and only crop
  // and shells bound `lower`. Elements that were cropped count: `lower` is a bound of their
  // distance, too. So do those that were left out in a shell which is thicker than trusted, and the
  // large ones of any shell, unless that is the shell of `object`.
  [[nodiscard]] NearestElement nearest(const ConvexBody& part, const RelativePose& part_from_cloud,
                                       SlabBody& body, CloudTracking& tracking,
                                       std::uint32_t most_overlap_work = kMostOverlapWork,
                                       std::uint32_t object = kNoObject) const noexcept {
    NearestElement found =
        depth() != nullptr
            ? nearest_element(part, *depth(), body, part_from_cloud, tracking, most_overlap_work)
            : nearest_element(part, *points(), part_from_cloud, tracking, most_overlap_work);
    if (found.answer == CloudAnswer::kBadPose) return found;
    if (crop_.radius < kInfinity)
      found.lower = std::min(found.lower, to_cropped(part, part_from_cloud));
    for (const HiddenNear& near : hidden_) {
      const bool is_trusted = near.shell.shell <= trusted_shell_;
      const CloudBox& counts = is_trusted ? near.shell.large : near.shell.all;
      if (!counts.is_empty() && near.object != object)
        found.lower = std::min(found.lower, to_box(counts, part, part_from_cloud));
    }
    found.upper += excess() * (1.0 + 0x1p-40);
    return found;
  }
  // No element exceeds what was measured by more than this, m: they are rounded outward, so that
  // `lower` holds. `upper` grows by it: what exceeds a set by this is nearer to any body by at most
  // this, and deeper in it. A depth is rounded by one step of a float, and a corner of its slab
  // moves along its ray; a ball's radius by two steps.
  [[nodiscard]] double excess() const noexcept {
    if (depth() != nullptr) return 0x1.1p-23 * depth()->extent();
    if (points()->shape() == ElementShape::kCube || points()->levels() == 0) return excess_;
    return excess_ + 0x1.1p-22 * double{points()->node(points()->levels() - 1, 0).radius};
  }
  // Replaces the excess that follows from the rounding of radii, where the message gives another.
  void note_excess(double excess) noexcept { excess_ = excess; }
  // The elements outside of this ball, in the frame of the cloud, may have been left out from now
  // on. Infinity: none were, as after a build.
  void note_crop(const CloudCrop& crop) noexcept { crop_ = crop; }
  [[nodiscard]] const CloudCrop& crop() const noexcept { return crop_; }

  // Visits all elements: visit(block, lane, centre, radius of a ball around it that contains it).
  template <class Visit>
  void for_each(const Visit& visit) const {
    if (const DepthCloud* const slabs = depth()) {
      for (std::size_t b = 0; b < slabs->blocks(); ++b) {
        if (DepthCloud::is_empty(slabs->node(0, b))) continue;
        for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
          if (slabs->block(b).low[lane] > slabs->block(b).high[lane]) continue;
          const DepthCloud::Slab slab = slabs->pixel_slab(b, lane);
          visit(b, lane, slab.middle(), slab.diameter());
        }
      }
      return;
    }
    for (std::size_t b = 0; b < points()->blocks(); ++b) {
      const PointCloud::Block& block = points()->block(b);
      for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
        if (block.is_present(lane))
          visit(b, lane, Vec3(block.x[lane], block.y[lane], block.z[lane]),
                points()->shape() == ElementShape::kCube ? kCubeRadius * block.radius[lane]
                                                         : double{block.radius[lane]});
      }
    }
  }
  // See DepthCloud::remove() and PointCloud::remove().
  void remove(std::size_t block, std::size_t lane) noexcept {
    if (DepthCloud* const slabs = depth()) return slabs->remove(block, lane);
    static_cast<void>(points()->remove(block, lane));
  }
  // See own_points.hpp. Call refit() after the last part.
  [[nodiscard]] BlindShell shelve(const ConvexBody& part, const RelativePose& part_from_cloud,
                                  double shell, const CentreLimit& limit, SlabBody& body) noexcept {
    if (DepthCloud* const slabs = depth())
      return shelve_own_points(part, part_from_cloud, shell, *slabs, body, limit);
    return shelve_own_points(part, part_from_cloud, shell, *points(), limit);
  }
  // Shells thicker than this count for the parts of other objects, m; as after the last build.
  void trust_shells(double thickest) noexcept { trusted_shell_ = thickest; }
  // By the caller, in ascending order of objects.
  [[nodiscard]] std::span<const HiddenNear> hidden() const noexcept { return hidden_; }
  [[nodiscard]] std::vector<HiddenNear>& hidden() noexcept { return hidden_; }

  void refit() noexcept {
    if (DepthCloud* const slabs = depth()) return slabs->refit();
    points()->refit();
  }

 private:
  // No point outside of the crop's ball is nearer to the part than this, m.
  [[nodiscard]] double to_cropped(const ConvexBody& part,
                                  const RelativePose& part_from_cloud) const noexcept {
    const Vec3 origin = -(part_from_cloud.rotation.transpose() * part_from_cloud.translation);
    const double lengths =
        origin.norm() + crop_.centre.norm() + crop_.radius + part.bounding_radius + part.radius;
    const double error = part_from_cloud.translation_error +
                         part_from_cloud.rotation_error * origin.norm() + 0x1p-46 * lengths;
    return crop_.radius - (origin - crop_.centre).norm() - part.bounding_radius - part.radius -
           part.position_error - error;
  }

  // No point of the box is nearer to the part than this, m.
  [[nodiscard]] static double to_box(const CloudBox& box, const ConvexBody& part,
                                     const RelativePose& part_from_cloud) noexcept {
    const Vec3 origin = -(part_from_cloud.rotation.transpose() * part_from_cloud.translation);
    const Vec3 nearest = origin.cwiseMax(box.low).cwiseMin(box.high);
    const double lengths = origin.norm() + nearest.norm() + part.bounding_radius + part.radius;
    const double error = part_from_cloud.translation_error +
                         part_from_cloud.rotation_error * origin.norm() + 0x1p-46 * lengths;
    return (origin - nearest).norm() - part.bounding_radius - part.radius - part.position_error -
           error;
  }

  explicit SeenCloud(std::variant<DepthCloud, PointCloud> cloud) : cloud_(std::move(cloud)) {}

  std::variant<DepthCloud, PointCloud> cloud_;
  std::vector<HiddenNear> hidden_;
  CloudCrop crop_{.centre = Vec3::Zero(), .radius = kInfinity};
  double excess_ = 0.0, trusted_shell_ = kInfinity;
  bool shows_known_ = false;
};

}  // namespace clearance
