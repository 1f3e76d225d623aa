// The content of one frame of a sensor, a depth image or points, behind one query.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "monitor/clouds/nearest_element.hpp"
#include "monitor/clouds/own_points.hpp"

namespace clearance {

// All memory is allocated at the start. It is built by one thread, and may then be read by any.
class SeenCloud {
 public:
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

  // `body` is scratch memory of the caller.
  [[nodiscard]] NearestElement nearest(const ConvexBody& part, const RelativePose& part_from_cloud,
                                       SlabBody& body, CloudTracking& tracking) const noexcept {
    if (const DepthCloud* const slabs = depth())
      return nearest_element(part, *slabs, body, part_from_cloud, tracking);
    return nearest_element(part, *points(), part_from_cloud, tracking);
  }
  // See own_points.hpp. Call refit() after the last part.
  [[nodiscard]] BlindShell shelve(const ConvexBody& part, const RelativePose& part_from_cloud,
                                  double shell, SlabBody& body) noexcept {
    if (DepthCloud* const slabs = depth())
      return shelve_own_points(part, part_from_cloud, shell, *slabs, body);
    return shelve_own_points(part, part_from_cloud, shell, *points());
  }
  void refit() noexcept {
    if (DepthCloud* const slabs = depth()) return slabs->refit();
    points()->refit();
  }

 private:
  explicit SeenCloud(std::variant<DepthCloud, PointCloud> cloud) : cloud_(std::move(cloud)) {}

  std::variant<DepthCloud, PointCloud> cloud_;
};

}  // namespace clearance
