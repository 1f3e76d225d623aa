// Writes for ROS 2 that may fail: failures are counted and logged at powers of two, which is often
// enough.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <functional>
#include <utility>

#include "monitor/app/log_line.hpp"

namespace clearance {

class RosWrites {
 public:
  // Returns whether this daemon leads: only the leader of two partners writes. Empty: it always
  // does.
  using Leads = std::function<bool()>;
  explicit RosWrites(Leads leads = {}) : leads_(std::move(leads)) {}

  [[nodiscard]] bool may_write() const { return !leads_ || leads_(); }
  void write(dds_entity_t writer, const void* sample) {
    const dds_return_t result = dds_write(writer, sample);
    if (result == DDS_RETCODE_OK) return;
    const std::uint64_t failed = ++failed_;
    if ((failed & (failed - 1)) == 0)
      log_line(lines::kRosWriteFailed, dds_strretcode(result), failed);
  }

 private:
  Leads leads_;
  std::uint64_t failed_ = 0;
};

}  // namespace clearance
