// The rows of a stopping table that count for one joint.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "config/cell/stop_table.hpp"

namespace clearance {

struct StopConditions {
  int category = 1;
  // Shares of the largest; nothing: the worst counts.
  std::optional<double> load = {}, extension = {};
};

// Returns the rows of one joint that count: those of the category, at the next printed load and
// extension from the stated ones on, and at all lower ones, since tables are not monotone. There
// are none if no row is of the category. It is a mistake if no step is as high as a stated one, and
// if a combination of the steps of load, extension and speed has no row.
[[nodiscard]] std::variant<std::vector<StopRow>, StopMistake> counted_rows(
    std::vector<StopRow> of_joint, const StopConditions& conditions);

}  // namespace clearance
