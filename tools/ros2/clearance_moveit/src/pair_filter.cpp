#include "pair_filter.hpp"

namespace clearance_moveit {
namespace {

using collision_detection::BodyTypes::ROBOT_LINK;

bool may_touch(const Owner& attached, const std::string& other) {
  return attached.attached != nullptr && attached.attached->getTouchLinks().count(other) != 0;
}

}  // namespace

PairFilter::PairFilter(const collision_detection::AllowedCollisionMatrix* matrix,
                       const std::set<const moveit::core::LinkModel*>* active, const PosedParts& a,
                       const PosedParts& b)
    : matrix_(matrix),
      active_(active),
      a_(a),
      b_(b),
      decisions_(a.owners.size() * b.owners.size(), Decision::kOpen) {}

const std::set<const moveit::core::LinkModel*>* PairFilter::links_of(
    const moveit::core::RobotModel& model, const std::string& group) {
  if (!model.hasJointModelGroup(group)) return nullptr;
  return &model.getJointModelGroup(group)->getUpdatedLinkModelsSet();
}

PairFilter::Decision PairFilter::decide(std::uint32_t owner_a, std::uint32_t owner_b) {
  Decision& kept = decisions_[owner_a * b_.owners.size() + owner_b];
  if (kept == Decision::kOpen) kept = look_up(a_.owners[owner_a], b_.owners[owner_b]);
  return kept;
}

PairFilter::Decision PairFilter::look_up(const Owner& a, const Owner& b) const {
  if (active_ != nullptr) {
    const auto is_active = [&](const Owner& owner) {
      return owner.link != nullptr && active_->count(owner.link) != 0;
    };
    if (!is_active(a) && !is_active(b)) return Decision::kLeftOut;
  }
  // A link may touch what lists it, and so may another attached body. Those of one link are still
  // to each other.
  const bool both_attached = a.attached != nullptr && b.attached != nullptr;
  if (both_attached && a.link == b.link) return Decision::kLeftOut;
  if ((both_attached || b.type == ROBOT_LINK) && may_touch(a, b.name)) return Decision::kLeftOut;
  if ((both_attached || a.type == ROBOT_LINK) && may_touch(b, a.name)) return Decision::kLeftOut;
  collision_detection::AllowedCollision::Type type;
  if (matrix_ == nullptr || !matrix_->getAllowedCollision(a.name, b.name, type))
    return Decision::kChecked;
  switch (type) {
    case collision_detection::AllowedCollision::ALWAYS:
      return Decision::kLeftOut;
    case collision_detection::AllowedCollision::CONDITIONAL:
      return Decision::kConditional;
    default:
      return Decision::kChecked;
  }
}

collision_detection::DecideContactFn PairFilter::decider(std::uint32_t owner_a,
                                                         std::uint32_t owner_b) const {
  collision_detection::DecideContactFn allowed;
  matrix_->getAllowedCollision(a_.owners[owner_a].name, b_.owners[owner_b].name, allowed);
  return allowed;
}

}  // namespace clearance_moveit
