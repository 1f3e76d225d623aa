// A robot that is attached or detached, as an entry of `robots`.
#pragma once

#include <optional>
#include <string>

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

// Sets the id of the body that stands for a person; empty: removes it.
[[nodiscard]] std::optional<ChangeFault> set_body(const std::string& id, const std::string& person,
                                                  YamlNode& node);

}  // namespace clearance
