// Writes what a daemon does in the text format of Prometheus (version 0.0.4).
#pragma once

#include <functional>
#include <string>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/loop/response_times.hpp"

namespace clearance {

struct MetricsSource {
  const Scene& scene;
  const clearance_msg_Health& health;
  const clearance_msg_Distances* report = nullptr;    // the last one; null: none has come
  std::function<bool(std::uint32_t zone)> is_active;  // empty: zones are not known
  const LoopStatistics* statistics = nullptr;         // null in other processes: no histograms
  const ResponseTimes* responses = nullptr;           // likewise
};

// README.md of this room lists the metrics. Allocates.
[[nodiscard]] std::string metrics_text(const MetricsSource& source);

}  // namespace clearance
