// The rules for every attached object, whether a cell, a command or a question attaches it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// An attached object is also in the groups of its carrier, and absent if that is. Its age limit,
// and the speed at which it may approach, are those of the carrier.
void take_over(const Object& carrier, Object& object);

// The same from a link without shapes, which has what the others of its robot have.
void take_over(const Robot& carrier, std::span<const Object> objects, Object& object);

// Makes the object `index` a robot of one link without a joint. What rounding of forward kinematics
// may do to its place counts as its error from now on. The robots before it are needed.
void be_carried(const RobotBase& base, std::uint32_t index, std::vector<Robot>& robots,
                const std::vector<JointVariable>& variables, Object& object);

// By object: the one that carries it, or kNoCarrier.
inline constexpr std::uint32_t kNoCarrier = std::numeric_limits<std::uint32_t>::max();
[[nodiscard]] std::vector<std::uint32_t> carriers_of(std::span<const Attachment> attachments,
                                                     std::size_t objects);

// Tells whether it has the name, or is in the group.
[[nodiscard]] bool is_named(const Object& object, const std::string& name);

// True for two objects that no rule makes a pair: two fixed ones, what two sensors see, and what a
// sensor sees with what has no end.
[[nodiscard]] bool never_meet(const Object& a, const Object& b);

// Why an object of people may not be on the robot's side of a zone as well.
[[nodiscard]] std::string on_both_sides(const Object& person);

// Chooses the steps of the stops of a robot by the masses that it carries; a mass that is not
// stated counts as the largest load. Returns what was found if no step is as high. The robot has
// CarriedLoad::steps.
[[nodiscard]] std::optional<std::string> choose_steps(std::uint32_t robot,
                                                      std::span<const Object> objects,
                                                      std::vector<Robot>& robots);

}  // namespace clearance
