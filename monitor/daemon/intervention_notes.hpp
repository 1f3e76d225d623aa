// The fields of a cell, and of a client that changes it, in the log of interventions.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/cell/cell.hpp"
#include "monitor/requests/scene_task.hpp"

namespace clearance {

// Names the sender of a task, and the changes that it asks for. `content` is the SHA-256 of a
// client's command as CDR.
[[nodiscard]] nlohmann::ordered_json note_of(const SceneTask& task);

// The texts that a client's command asks to be logged; a dry run asks for nothing.
[[nodiscard]] std::vector<std::string> notes_of(const SceneTask& task);

// The revision, the hashes of the cell and of its files, and the contacts that it allows.
[[nodiscard]] nlohmann::ordered_json note_of(const Cell& cell);

}  // namespace clearance
