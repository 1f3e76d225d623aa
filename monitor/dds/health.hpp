// What the health topic says, put together from the loop's statistics and the ports' counts.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

[[nodiscard]] Sample<clearance_msg_Health> make_health(const Scene& scene,
                                                       const LoopStatistics& statistics,
                                                       const PoseReader& poses,
                                                       std::uint64_t dropped_reports);

// Tells the log which rejections, losses and late inputs are new since the health before: a few
// lines a second at most.
class HealthLog {
 public:
  explicit HealthLog(const Scene& scene);
  void update(const clearance_msg_Health& health);

 private:
  std::map<std::string, std::uint64_t> rejected_;  // by "object: cause"
  std::vector<bool> stale_;                        // by object
  std::uint64_t lost_ = 0, overruns_ = 0, dropped_ = 0;
};

}  // namespace clearance
