// A robot that is attached or detached, as an entry of `robots`.
#pragma once

#include <optional>

#include "config/edit/cell_change.hpp"
#include "config/edit/change_document.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// Each edits the entry. `pose` is that of the change, in the units of the cell. After a fault the
// entry may have changed.
[[nodiscard]] std::optional<ChangeFault> move_robot(const AttachRobot& change, YamlNode pose,
                                                    YamlNode& node);
[[nodiscard]] std::optional<ChangeFault> move_robot(const DetachRobot& change, YamlNode pose,
                                                    YamlNode& node);

}  // namespace clearance
