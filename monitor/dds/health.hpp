// Makes the samples of the health topic from the statistics of the loop and the counts of the
// ports.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/dds/recording_health.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Allocates: called once a second, in the thread that publishes or records. `dropped_reports` are
// those that never reached DDS or the file.
[[nodiscard]] Sample<clearance_msg_Health> make_health(const Scene& scene,
                                                       const LoopStatistics& statistics,
                                                       const PoseReader& poses,
                                                       std::uint64_t dropped_reports,
                                                       const RecordingHealth& recording = {});

// Tells the log which rejections, losses and late inputs are new since the health before: a few
// lines a second at most.
class HealthLog {
 public:
  explicit HealthLog(const Scene& scene);
  // To be called with every sample, in order.
  void update(const clearance_msg_Health& health);

 private:
  void log_clock(const clearance_msg_Health& health);

  std::map<std::string, std::uint64_t> rejected_;  // by "object: cause"
  std::vector<bool> stale_;                        // by object
  std::vector<std::string> other_source_;          // by object
  std::uint64_t clock_steps_ = 0;
  std::int64_t clock_offset_ns_ = 0;
  std::uint64_t lost_ = 0, undecodable_ = 0, foreign_ = 0, overruns_ = 0, dropped_ = 0;
};

}  // namespace clearance
