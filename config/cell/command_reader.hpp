// Reads `commands:`, `questions:` and `capacity:` of a cell file.
#pragma once

#include <filesystem>

#include "config/cell/command_settings.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// Relative folders are relative to that of the cell, `directory`.
[[nodiscard]] CommandSettings read_commands(const YamlNode& node,
                                            const std::filesystem::path& directory,
                                            Diagnostics& diagnostics);

[[nodiscard]] QuestionSettings read_questions(const YamlNode& node, Diagnostics& diagnostics);

[[nodiscard]] AddedCapacity read_capacity(const YamlNode& node, Diagnostics& diagnostics);

}  // namespace clearance
