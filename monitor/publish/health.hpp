// Makes the samples of the health topic from the statistics of the loop and the counts of the
// ports.
#pragma once

#include <cstdint>

#include "config/scene/scene.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/loop/response_times.hpp"
#include "monitor/publish/recording_health.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Allocates: called once per second, in the thread that publishes or records. `dropped_reports`
// never reached DDS or the file. `responses`: null: they are not known.
[[nodiscard]] Sample<clearance_msg_Health> make_health(const Scene& scene,
                                                       const LoopStatistics& statistics,
                                                       const PoseReader& poses,
                                                       std::uint64_t dropped_reports,
                                                       const RecordingHealth& recording = {},
                                                       const ResponseTimes* responses = nullptr);

}  // namespace clearance
