// The response times of a daemon's reports, by input: the age of what the input sent last at the
// tick, and from then until the report was handed to DDS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/loop/ports.hpp"

namespace clearance {

struct InputResponse {
  std::string input;  // a source, or "sensor " and its name
  std::int64_t p50_ns = 0, max_ns = 0;
};

// One thread adds; any thread reads. Figures are since the start.
class ResponseTimes {
 public:
  ResponseTimes();

  void add(const ReportStart& start, std::int64_t delay_ns);
  // Once per second: what the inputs are called. One that has another name begins anew.
  void name(const LoopStatistics& statistics, const Scene& scene);

  // Of the slowest input of each tick.
  [[nodiscard]] Histogram slowest() const;
  // Without the age of inputs: from the tick until the report was handed to DDS.
  [[nodiscard]] Histogram delays() const;
  // The one with the longest response first. Allocates.
  [[nodiscard]] std::vector<InputResponse> inputs() const;

 private:
  struct Input {
    std::string name;
    Histogram times;
  };

  mutable Mutex mutex_;
  GUARDED_BY(mutex_) std::vector<Input> inputs_;  // as ReportStart::ages_ns
  GUARDED_BY(mutex_) Histogram slowest_, delays_;
};

}  // namespace clearance
