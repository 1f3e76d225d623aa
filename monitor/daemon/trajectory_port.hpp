// Motions on topics of ROS 2, trajectory_msgs/JointTrajectory: each one is asked about before, or
// while, a controller makes it. The answer is a status of /diagnostics, and a number.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/ros_settings.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/ros_writes.hpp"
#include "monitor/requests/question_desk.hpp"

namespace clearance {

// The number on TOPIC/clearance is the certified lower bound of the distance over the whole motion,
// m; -infinity if nothing is known of it.
class TrajectoryPort {
 public:
  using Put = std::function<bool(QueuedQuestion)>;

  // The participant must outlive this. `leads`: see RosWrites. Throws DdsError.
  TrajectoryPort(std::string cell, RosTrajectories options, Participant& participant, Put put,
                 RosWrites::Leads leads);
  // Nothing may be answered any more (QuestionDesk::end).
  ~TrajectoryPort();
  TrajectoryPort(const TrajectoryPort&) = delete;
  TrajectoryPort& operator=(const TrajectoryPort&) = delete;

  // Starts the thread.
  void start();

 private:
  struct Topic {
    std::string name;
    dds_entity_t reader = 0, number = 0;
    std::uint64_t last = 0;  // the number of its last motion
  };
  void run();
  void take(Topic& topic, const CdrSample& sample);
  void write(const Topic& topic, const QuestionResult& result);

  const std::string cell_;
  const RosTrajectories options_;
  const Put put_;
  std::vector<Topic> topics_;
  dds_entity_t diagnostics_;
  std::unique_ptr<DataWait> wait_;
  std::vector<CdrSample> taken_;
  Mutex mutex_;  // answers come from several threads
  GUARDED_BY(mutex_) RosWrites writes_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
