// The topics of a running daemon, as any client reads them: of the reports the newest only.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/ros_readers.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"
#include "tools/view/frame.hpp"
#include "tools/view/source.hpp"

namespace clearance::view {

class LiveSource final : public Source {
 public:
  // Throws DdsError. `cell` must outlive it.
  LiveSource(const Cell& cell, const DdsOptions& dds);

  // Without viewers nothing is taken: readers of poses keep the newest, and there are none of
  // reports.
  void advance(Server& server) override;

 private:
  void join(TopicKind kind);
  void leave(Server& server);
  void take(TopicKind kind);
  void take_from_ros(const Now& now);
  void tell_of_the_daemon(Server& server, std::int64_t now_ns);

  const Scene& scene_;
  const Topics& topics_;
  Participant participant_;
  std::array<dds_entity_t, kRecordedTopics.size()> readers_{};  // 0: there is none
  std::vector<CdrSample> taken_;
  Frame frame_;
  Intake intake_;  // of ROS 2's topics
  RosReaders ros_;
  bool heard_ = false;           // a report has come since there is a viewer
  std::int64_t watched_ns_ = 0;  // when there was a viewer last, CLOCK_MONOTONIC
};

}  // namespace clearance::view
