#include "monitor/loop/response_times.hpp"

#include <algorithm>
#include <utility>

namespace clearance {

ResponseTimes::ResponseTimes() : inputs_(kMostInputs) {}

void ResponseTimes::add(const ReportStart& start, std::int64_t delay_ns) {
  const Lock lock(mutex_);
  delays_.add(delay_ns);
  std::int64_t oldest_ns = -1;
  for (std::size_t i = 0; i < kMostInputs; ++i) {
    if (start.ages_ns[i] < 0) continue;
    inputs_[i].times.add(start.ages_ns[i] + delay_ns);
    oldest_ns = std::max(oldest_ns, start.ages_ns[i]);
  }
  if (oldest_ns >= 0) slowest_.add(oldest_ns + delay_ns);
}

void ResponseTimes::name(const LoopStatistics& statistics, const Scene& scene) {
  const Lock lock(mutex_);
  for (std::size_t i = 0; i < kMostInputs; ++i) {
    const std::size_t sensor = i - kMaxSources;
    std::string name;
    if (i < kMaxSources) {
      name = statistics.sources[i].view();
    } else if (sensor < scene.sensors.size()) {
      name = "sensor " + scene.sensors[sensor].name;
    }
    if (!inputs_[i].name.empty() && inputs_[i].name != name) inputs_[i].times = {};
    inputs_[i].name = std::move(name);
  }
}

Histogram ResponseTimes::slowest() const {
  const Lock lock(mutex_);
  return slowest_;
}

Histogram ResponseTimes::delays() const {
  const Lock lock(mutex_);
  return delays_;
}

std::vector<InputResponse> ResponseTimes::inputs() const {
  std::vector<InputResponse> all;
  {
    const Lock lock(mutex_);
    for (const Input& input : inputs_) {
      if (input.times.count() > 0 && !input.name.empty())
        all.push_back({input.name, input.times.percentile_ns(0.5), input.times.max_ns()});
    }
  }
  std::ranges::sort(all, std::ranges::greater(), &InputResponse::max_ns);
  return all;
}

}  // namespace clearance
