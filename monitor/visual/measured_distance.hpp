// The distance of any two objects at the poses that a viewer shows, whether or not a rule of the
// cell pairs them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/stated_errors.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/visual/object_poses.hpp"

namespace clearance {

// These are like a pair of a report, margins not subtracted: lower <= the distance of the bodies at
// these poses
// <= upper, m. Witness points are in the world.
struct MeasuredDistance {
  PairStatus status = PairStatus::kUnknown;
  double distance = std::numeric_limits<double>::quiet_NaN();
  double lower = -kInfinity, upper = kInfinity;
  Vec3 witness_a = Vec3::Constant(distance), witness_b = witness_a;
};

class MeasuredDistances {
 public:
  // `scene` must outlive this.
  explicit MeasuredDistances(const Scene& scene)
      : scene_(scene), errors_(scene), parts_(parts_of(scene)), first_(first_parts(scene)) {}

  // Unknown for one object alone, for what a sensor sees, for numbers that the scene does not have,
  // and while the pose of one of the objects is missing, late or contradicted.
  [[nodiscard]] MeasuredDistance between(std::uint32_t a, std::uint32_t b,
                                         const ObjectPoses& poses);

 private:
  const Scene& scene_;
  StatedErrors errors_;
  std::vector<PosedPart> parts_;
  std::vector<std::uint32_t> first_;
};

}  // namespace clearance
