// Motions that no question states: of joints of other robots, and of objects that carry robots.
#include <algorithm>
#include <cmath>

#include "monitor/ask/posture.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// The rounding of a stated motion of a carrying object, relative to the lengths in it.
constexpr double kCarrierRounding = 0x1p-44;

}  // namespace

std::optional<std::string> Posture::set_deviations() {
  std::optional<std::string> fault;
  trajectory_.for_each_deviation([&](std::uint32_t variable, double most) {
    if (!(most >= 0.0) || !std::isfinite(most))
      fault = "a deviation of joint \"" + scene_.variables[variable].name +
              "\" is not a number from 0 on";
    if (most > 0.0)
      free_variables_.push_back(
          {.variable = variable, .speed = kInfinity, .age = 1.0, .most = most});
  });
  return fault;
}

std::optional<std::string> Posture::set_free(const StatedJoint& stated, OthersMove others) {
  std::uint32_t variable = 0;
  if (auto text = set_variable(stated.name, stated.position, variable)) return text;
  if (!(stated.age >= 0.0) || !std::isfinite(stated.age))
    return "the age of joint \"" + stated.name + "\" is not a number from 0 on";
  // An object that rests by assumption is no part of the question, like one that moves by one.
  if (others == OthersMove::kNot) {
    free_variables_.push_back({.variable = variable, .age = stated.age});
    return std::nullopt;
  }
  const JointVariable& joint = scene_.variables[variable];
  // A joint that exceeds its limit is not bounded by it.
  FreeVariable free{
      .variable = variable, .speed = std::max(joint.max_speed, stated.speed), .age = stated.age};
  const double most = std::max(joint.upper - stated.position, stated.position - joint.lower) +
                      joint.limit_tolerance;
  if (std::isfinite(most)) free.most = std::max(0.0, rounded_up(most));
  if (!(stated.most >= 0.0))
    return "what joint \"" + stated.name + "\" deviates by is not a number from 0 on";
  free.most = std::min(free.most, stated.most);
  if (free.most == 0.0) free.speed = 0.0;
  if (!std::isfinite(free.speed) && !std::isfinite(free.most)) {
    return "joint \"" + stated.name +
           "\" has neither a limit of its velocity nor of its position: hold it, state its motion, "
           "or that others do not move";
  }
  free_variables_.push_back(free);
  return std::nullopt;
}

void Posture::free_carriers(const Question& question) {
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    const RobotBase& base = scene_.robots[r].base;
    if (base.kind != RobotBase::Kind::kObject || present_[base.object] == 0) continue;
    const double age = age_[base.object], v = speed_[base.object], w = turn_speed_[base.object];
    const std::uint32_t variable = chains_.of_carrier(r);
    const bool is_stated = std::ranges::find(moving_objects_, base.object) != moving_objects_.end();
    const bool may_move = !is_stated && scene_.objects[base.object].max_speed > 0.0;
    if (may_move && question.others == OthersMove::kNot)
      free_variables_.push_back({.variable = variable});
    if (v > 0.0) free_variables_.push_back({.variable = variable, .speed = v, .age = age});
    // An object that does not move at all does not rotate.
    if (v > 0.0 && w > 0.0)
      free_variables_.push_back({.variable = variable + 1, .speed = w, .age = age});
  }
}

// A link counts for the question if something states its motion: or if nothing may move it.
void Posture::note_free() {
  const auto deviates = [](const FreeVariable& free) { return free.speed > 0.0; };
  any_free_ = std::ranges::any_of(free_variables_, deviates) || stops_.may_deviate();
  std::fill(freedom_.begin(), freedom_.end(), Nearing());
  std::fill(is_of_question_.begin(), is_of_question_.end(), std::uint8_t{1});
  std::fill(may_deviate_.begin(), may_deviate_.end(), Deviates::kNot);
  if (free_variables_.empty() && !stops_.may_deviate()) return;
  is_free_.assign(bounds_.size(), 0);
  is_stated_.assign(bounds_.size(), 0);
  for (const FreeVariable& free : free_variables_) is_free_[free.variable] = 1;
  for (const std::uint32_t moved : trajectory_.moved()) is_stated_[moved] = 1;
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    const bool on_object = scene_.robots[r].base.kind == RobotBase::Kind::kObject;
    const auto carrier = scene_.robots[r].base.object;
    if (on_object && std::ranges::find(moving_objects_, carrier) != moving_objects_.end())
      is_stated_[chains_.of_carrier(r)] = 1;
  }
  for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
    if (!is_link(i)) continue;
    bool free = false, stated = false;
    chains_.for_each_variable(i, [&](std::uint32_t v) {
      free = free || is_free_[v] != 0;
      stated = stated || is_stated_[v] != 0;
    });
    if (free && any_free_)
      may_deviate_[i] = Deviates::kByAssumption;
    else if (stated && stops_.may_deviate())
      may_deviate_[i] = Deviates::kByStop;
    is_of_question_[i] = stated || !free;
  }
}

void Posture::note_freedom(const Stretch& stretch, double at) noexcept {
  const Instants since = elapsed(stretch, at);
  if (stops_.may_deviate()) std::ranges::fill(freedom_, Nearing());
  for (const FreeVariable& free : free_variables_) {
    const auto until = [&](double t) {
      const double aged = t + free.age;
      return aged > 0.0 ? std::min(free.most, free.speed * aged) : 0.0;
    };
    freedom_[free.variable] = {rounded_up(until(since.end)),
                               rounded_down_if_finite(until(since.middle)),
                               rounded_down_if_finite(until(since.begin))};
  }
  if (stops_.counts() && stops_.may_deviate()) stops_.add_deviations(freedom_);
}

double Posture::carrier_rounding(const Sphere& sphere, std::uint32_t base) const noexcept {
  if (carrier_extent_ == 0.0) return 0.0;
  const double to_base = is_link(base) ? link_state(base).pose.position.norm() + radii_[base] : 0.0;
  return kCarrierRounding *
         (2.0 * carrier_extent_ + sphere.centre.norm() + sphere.radius + to_base);
}

// The robots on objects whose motion is stated.
void Posture::place_carriers() noexcept {
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    const RobotBase& base = scene_.robots[r].base;
    if (base.kind != RobotBase::Kind::kObject) continue;
    const std::uint32_t v = chains_.of_carrier(r);
    for (const ObjectState& state : moving_.states()) {
      if (state.object != base.object) continue;
      bases_[r].pose = state.pose;
      bases_[r].twist = {state.velocity, state.angular};
      bounds_[v] = {.deviation = state.shift, .speed = rounded_up(state.velocity.norm())};
      bounds_[v + 1] = {.deviation = state.turn, .speed = rounded_up(state.angular.norm())};
    }
  }
}

Twist Posture::twist_of_carrier(std::uint32_t link_object, Vec3& origin) const noexcept {
  const std::uint32_t carrier = chains_.carrier_of(link_object);
  origin = pose_[carrier].position;
  for (const ObjectState& state : moving_.states()) {
    if (state.object == carrier) return {state.velocity, state.angular};
  }
  return {};
}

}  // namespace clearance
