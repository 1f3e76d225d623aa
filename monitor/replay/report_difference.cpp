#include "monitor/replay/report_difference.hpp"

#include <fmt/format.h>

#include "monitor/files/build_info.hpp"
#include "monitor/replay/message_difference.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {

ReportDifference::ReportDifference(const Scene& scene, Comparison how, bool some_without_pairs)
    : scene_(scene),
      how_(how),
      some_without_pairs_(some_without_pairs),
      replayed_(make_distances(scene)),
      separation_(make_separation(scene)),
      gradients_(scene) {}

// The report comes first, since the other messages follow from it. If only bounds are compared, the
// other messages are not, because other bounds lead to other separations and gradients.
std::optional<std::string> ReportDifference::first(const TickInput& input, const Report& report,
                                                   std::uint64_t cycle_offset,
                                                   const std::set<std::string>& not_recorded) {
  to_wire(report, input.sources, 0, *replayed_);
  if (some_without_pairs_ && input.recorded->pairs._length == 0) replayed_->pairs._length = 0;
  if (how_ == Comparison::kBounds) return bounds_difference(scene_, *input.recorded, *replayed_);
  const DifferenceOptions options{.cycle_offset = cycle_offset, .not_recorded = &not_recorded};
  if (auto found = message_difference(scene_, *input.recorded, *replayed_, options)) return found;
  if (input.separation != nullptr) {
    to_wire(report, 0, *separation_);
    if (some_without_pairs_ && input.separation->pairs._length == 0) separation_->pairs._length = 0;
    if (const auto found = message_difference(scene_, *input.separation, *separation_, options))
      return "separation." + *found;
  }
  if (input.gradients != nullptr && scene_.gradients) {
    const auto found =
        message_difference(scene_, *input.gradients, gradients_.of(report, 0), options);
    if (found) return "gradients." + *found;
  }
  return std::nullopt;
}

std::string other_build(const std::string& recorded) {
  if (recorded == kBuild) return {};
  const std::string ours = kBuild;
  if (recorded.empty()) {
    return fmt::format(
        "; the recording does not name its build: if that is not this one ({}), it may be the "
        "reason",
        ours);
  }
  return fmt::format("; it was recorded by another build ({}), which may be the reason: this is {}",
                     recorded, ours);
}

}  // namespace clearance
