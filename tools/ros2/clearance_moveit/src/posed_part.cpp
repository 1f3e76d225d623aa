#include "posed_part.hpp"

namespace clearance_moveit {

Box placed(const Box& box, const Pose& pose) noexcept {
  if (!(box.high - box.low).allFinite()) return {};
  const clearance::Mat3 rotation = clearance::rotation_matrix(pose.orientation);
  const Vec3 centre = rotation * (0.5 * (box.low + box.high)) + pose.position;
  Vec3 half = rotation.cwiseAbs() * (0.5 * (box.high - box.low));
  half.array() += 1e-14 * (box.low.norm() + box.high.norm() + pose.position.norm());
  // No number: the query says that nothing is known, so it has to be made.
  if (!(centre - half).allFinite() || !(centre + half).allFinite()) return {};
  return {centre - half, centre + half};
}

}  // namespace clearance_moveit
