// The changes of a cell by a list of tracked bodies: which person of the cell has which body.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "config/scene/scene.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A person of the cell whose body is in the list keeps it. The others get bodies that have none, in
// the order of both; who is left over is absent. If bodies are left over, the last person is there
// and nothing says where: it stands for them. So it does for a body that is named twice, or like a
// robot of the cell. Without `bodies`, it is not known which are there, and so it is with all
// persons. Persons that stay as they are need no change.
[[nodiscard]] std::vector<CellChange> changes_by_bodies(
    const std::optional<std::vector<std::string>>& bodies, const Scene& scene);

// The same for a message hri_msgs/IdsList. One without bytes, or that does not decode, says
// nothing.
[[nodiscard]] std::vector<CellChange> changes_by_bodies(std::span<const std::byte> cdr,
                                                        CdrBytes bytes, const Scene& scene);

}  // namespace clearance
