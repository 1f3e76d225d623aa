// The extension of a posture and the masses that an arm carries choose among the steps of a
// stopping table.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/cell/robot_reader.hpp"
#include "config/cell/stop_steps.hpp"
#include "config/scene/robot.hpp"
#include "config/yaml/diagnostics.hpp"

namespace clearance {

// Returns how the distance of the link from the axis of the first joint that turns below it is
// measured. Else returns what was found and expected. `link` is a name without the prefix; `reach`
// is in m.
[[nodiscard]] std::variant<Extension, std::string> measured_extension(
    const Robot& robot, std::span<const JointVariable> variables, const std::string& link,
    double reach);

// Returns the conditions of each step, ascending: of all printed loads and extensions of the
// category, where they are measured, and of the stated ones where not. There is at least one.
[[nodiscard]] std::vector<StopConditions> measured_steps(
    std::span<const std::vector<StopRow>> of_joint, const StopConditions& stated,
    bool is_load_measured, bool is_extension_measured);

// Chooses the steps of the load that each robot carries. Reports a robot that carries more than its
// table has. A mass that is not stated counts as the largest load.
void use_carried_loads(const ObjectList& list, RobotList& robots, Diagnostics& diagnostics);

}  // namespace clearance
