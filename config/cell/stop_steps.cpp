#include "config/cell/stop_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace clearance {
namespace {

using Share = double StopRow::*;

std::set<double> steps_of(const std::vector<StopRow>& rows, Share share) {
  std::set<double> steps;
  for (const StopRow& row : rows) steps.insert(row.*share);
  return steps;
}

// Leaves out the rows above the step that stands for `stated`. Returns false if no step is as high.
bool keep_up_to(std::optional<double> stated, Share share, std::vector<StopRow>& rows) {
  if (!stated) return true;
  const std::set<double> steps = steps_of(rows, share);
  const auto step = steps.lower_bound(*stated);
  if (step == steps.end()) return false;
  std::erase_if(rows, [&](const StopRow& row) { return row.*share > *step; });
  return true;
}

StopMistake no_step(const StopRow& row, const char* what, double stated) {
  return {row.place, fmt::format("found no row of the joint '{}' from {:g} % {} on; expected one, "
                                 "or a lower {} stated",
                                 row.joint, 100.0 * stated, what, what)};
}

// A row that was forgotten may be the worst one.
std::optional<StopMistake> gap_in(const std::vector<StopRow>& rows) {
  std::set<std::tuple<double, double, double>> printed;
  for (const StopRow& row : rows) printed.emplace(row.load, row.extension, row.speed);
  for (const double load : steps_of(rows, &StopRow::load)) {
    for (const double extension : steps_of(rows, &StopRow::extension)) {
      for (const double speed : steps_of(rows, &StopRow::speed)) {
        if (printed.contains({load, extension, speed})) continue;
        return StopMistake{
            rows.front().place,
            fmt::format("found no row of the joint '{}' at {:g} % load, {:g} % extension and {:g} "
                        "% speed; expected one for each combination of its steps",
                        rows.front().joint, 100.0 * load, 100.0 * extension, 100.0 * speed)};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::variant<std::vector<StopRow>, StopMistake> counted_rows(std::vector<StopRow> of_joint,
                                                             const StopConditions& conditions) {
  std::erase_if(of_joint, [&](const StopRow& row) {
    return row.category >= 0 && row.category != conditions.category;
  });
  if (of_joint.empty()) return of_joint;
  if (auto gap = gap_in(of_joint)) return *std::move(gap);
  const StopRow first = of_joint.front();
  if (!keep_up_to(conditions.load, &StopRow::load, of_joint))
    return no_step(first, "load", *conditions.load);
  if (!keep_up_to(conditions.extension, &StopRow::extension, of_joint))
    return no_step(first, "extension", *conditions.extension);
  return of_joint;
}

}  // namespace clearance
