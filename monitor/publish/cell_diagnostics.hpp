// The health of a cell as diagnostics of ROS 2: the content of the health topic and the zones as
// levels and texts.
//
// OK: known and on time. WARN: late, active or overrun; figures still hold, with wider bounds.
// ERROR: not known, so nothing is clear of it.
#pragma once

#include <cstdint>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/publish/diagnostic_status.hpp"

namespace clearance {

class CellDiagnostics {
 public:
  // The scene must outlive this.
  explicit CellDiagnostics(const Scene& scene) : scene_(scene) {}

  // Called with every health sample, in order, and with the report before it. The statuses are:
  // tick, distances, poses, joints of each robot, each zone, each share of a joined cell, and the
  // recording if there is one. Allocates.
  [[nodiscard]] Sample<DiagnosticArray> make(const clearance_msg_Health& health,
                                             const Report& report, std::int64_t stamp_ns);

 private:
  const Scene& scene_;
  std::uint64_t overruns_ = 0, dropped_ = 0;
};

}  // namespace clearance
