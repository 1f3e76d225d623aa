// Compares a replayed report, and the messages that follow from it, with those of the recording.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/replay/comparison.hpp"
#include "monitor/replay/tick_feed.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/gradient_message.hpp"

namespace clearance {

class ReportDifference {
 public:
  // Compares reports of `scene`, which must outlive this. `some_without_pairs`: reports may have
  // been recorded without their pairs (RecordingOptions::pairs_every).
  ReportDifference(const Scene& scene, Comparison how, bool some_without_pairs);

  // The first field that differs, as message_difference() names it. The input has a recorded
  // report. Its cycle is `cycle_offset` larger than that of the replayed one. `not_recorded`:
  // fields that the recording's build did not have.
  [[nodiscard]] std::optional<std::string> first(const TickInput& input, const Report& report,
                                                 std::uint64_t cycle_offset,
                                                 const std::set<std::string>& not_recorded);

 private:
  const Scene& scene_;
  Comparison how_;
  bool some_without_pairs_;
  Sample<clearance_msg_Distances> replayed_;
  Sample<clearance_msg_Separation> separation_;
  GradientMessage gradients_;
};

// Added to the text of a difference when another build than this one may be the reason.
[[nodiscard]] std::string other_build(const std::string& recorded);

}  // namespace clearance
