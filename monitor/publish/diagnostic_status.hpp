// Statuses of diagnostic_msgs/DiagnosticArray.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;
enum class DiagnosticLevel : std::uint8_t { kOk = 0, kWarn = 1, kError = 2 };

struct DiagnosticText {
  std::string name, message;
  DiagnosticLevel level = DiagnosticLevel::kOk;
  std::vector<std::pair<std::string, std::string>> values = {};

  // The first message of the highest level stays.
  void raise(DiagnosticLevel to, std::string why) {
    if (to <= level) return;
    level = to;
    message = std::move(why);
  }
};

// Names of statuses get "clearance CELL: " before them. Allocates.
[[nodiscard]] Sample<DiagnosticArray> diagnostic_array(const std::string& cell,
                                                       std::span<const DiagnosticText> statuses,
                                                       std::int64_t stamp_ns);

}  // namespace clearance
