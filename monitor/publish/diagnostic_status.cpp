#include "monitor/publish/diagnostic_status.hpp"

#include <fmt/format.h>

namespace clearance {
namespace {

char* copied(const std::string& text) { return dds_string_dup(text.c_str()); }

void to_wire(const std::string& cell, const DiagnosticText& status,
             diagnostic_msgs_msg_dds__DiagnosticStatus_& out) {
  out.level = static_cast<std::uint8_t>(status.level);
  out.name = copied(fmt::format("clearance {}: {}", cell, status.name));
  out.message = copied(status.message);
  out.hardware_id = copied(cell);
  reserve_sequence(out.values, status.values.size());
  for (const auto& [key, value] : status.values)
    out.values._buffer[out.values._length++] = {copied(key), copied(value)};
}

}  // namespace

Sample<DiagnosticArray> diagnostic_array(const std::string& cell,
                                         std::span<const DiagnosticText> statuses,
                                         std::int64_t stamp_ns) {
  Sample<DiagnosticArray> sample;
  sample->header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
  sample->header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
  sample->header.frame_id = copied("");
  reserve_sequence(sample->status, statuses.size());
  for (const DiagnosticText& status : statuses)
    to_wire(cell, status, sample->status._buffer[sample->status._length++]);
  return sample;
}

}  // namespace clearance
