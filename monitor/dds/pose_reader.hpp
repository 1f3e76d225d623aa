// The topics of poses and joint states, ours and ROS 2's, and its tf, as a PoseSource: a thread of
// its own takes samples and hands them to the tick thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/name_limit.hpp"
#include "monitor/dds/pose_sources.hpp"
#include "monitor/dds/present_topics.hpp"
#include "monitor/dds/ros_joint_states.hpp"
#include "monitor/dds/ros_transforms.hpp"
#include "monitor/dds/slow_input_log.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/spsc_ring.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {

// next() is called by the tick thread and takes no lock; everything else by other threads.
class PoseReader final : public PoseSource {
 public:
  // Poses that one batch may hold; what a source sends beyond it is counted and not used.
  [[nodiscard]] static std::size_t samples_a_batch(const Scene& scene) noexcept;
  [[nodiscard]] static std::size_t joints_a_batch(const Scene& scene) noexcept;
  // Batches that may wait for one tick.
  static constexpr std::size_t kBatches = 128;
  // Samples of a source that may arrive while the taking thread is held up.
  static constexpr std::int32_t kDepth = topic(TopicKind::kPoses).reader_depth;

  // Starts the thread. Scene and participant must outlive this.
  PoseReader(const Cell& cell, Participant& participant);
  ~PoseReader() override;

  const PoseBatch* next() noexcept override;

  // Any thread but the tick's.
  [[nodiscard]] std::vector<SourceTally> tallies() const;
  [[nodiscard]] std::vector<RefusedSource> refused_sources() const;
  // What sources that have given up their places had counted.
  [[nodiscard]] SourceTally departed() const;
  // Samples of writers that use more names than NameLimit allows.
  [[nodiscard]] std::uint64_t refused_names() const { return names_.refused(); }
  // Samples that Cyclone could not decode since this was made: it drops them with a line in its
  // log, which is where they are counted. Those of other readers of the process count as well.
  [[nodiscard]] std::uint64_t undecodable() const;
  // Who sends joint states; where nobody does, what is there instead. A sentence for a person who
  // hears nothing of a robot.
  [[nodiscard]] std::string senders_of_joints() const;

 private:
  dds_entity_t make_reader(Participant& participant, TopicKind kind);
  void run();
  template <class Taken>
  void take_all(dds_entity_t reader, Taken& taken);
  void note_writers();
  void hand_over(clearance_msg_PoseBatch& batch, std::uint64_t writer);
  void hand_over(clearance_msg_JointStates& states, std::uint64_t writer);
  void hand_over(const RosStates& states);
  void hand_over(const PoseBatch& of_frames);
  // `fill` writes poses or joints into a slot for the tick.
  template <class Fill>
  void hand_over_filled(SourceTally& tally, const Fill& fill);
  [[nodiscard]] bool hears_ros() const noexcept;
  [[nodiscard]] std::vector<dds_entity_t> readers() const;
  void take_from_ros();
  // Null: the batch, of `count` poses or joints, is refused. Counts what is missing before it.
  SourceTally* admit(dds_entity_t reader, const SourceName& source, std::uint64_t sequence_number,
                     std::size_t count, std::uint64_t writer);

  const Scene& scene_;
  const Topics& topics_;
  std::size_t samples_a_batch_;
  std::uint64_t undecodable_before_;
  NameLimit names_;
  std::atomic<bool> writers_changed_{false};
  dds_entity_t reader_;
  dds_entity_t joint_reader_;  // 0: the cell has no robots
  std::string where_;
  PresentTopics present_;
  RosJointStates ros_joints_;
  RosTransforms ros_transforms_;
  DataWait wait_;
  std::array<Sample<clearance_msg_PoseBatch>, kDepth> taken_;
  std::array<Sample<clearance_msg_JointStates>, kDepth> taken_joints_;
  JointNames joint_names_;
  SpscRing<PoseBatch> ring_;
  bool lent_ = false;  // the front slot is with the tick

  mutable std::mutex
      tallies_mutex_;  // between the taking and the publishing thread; never the tick's
  PoseSources sources_;
  SlowInputLog slow_log_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
