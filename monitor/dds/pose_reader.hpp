// The topics of poses and joint states, ours and ROS 2's, and its tf, as a PoseSource: a thread of
// its own takes samples, has them decoded and admitted (intake/), and hands batches to the tick
// thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/name_limit.hpp"
#include "monitor/dds/ros_readers.hpp"
#include "monitor/intake/intake.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/spsc_ring.hpp"
#include "monitor/participant/participant.hpp"

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

  // Starts the thread. Cell and participant must outlive this.
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
  // One of our own topics.
  struct OwnReader {
    dds_entity_t handle;
    std::uint32_t topic;
  };

  void open(Participant& participant, TopicKind kind);
  void run();
  void look();
  void note_writers();
  void take_all(const Now& now);
  bool hand_over(PoseBatch& batch) noexcept;
  void log_news();
  [[nodiscard]] std::string guid_of(std::uint64_t writer) const;

  const Topics& topics_;
  std::uint64_t undecodable_before_;
  NameLimit names_;
  std::atomic<bool> writers_changed_{false};
  std::string where_;
  // Between the taking and the publishing thread, never the tick's: guards the intake, and what
  // `ros_` knows of others.
  mutable std::mutex mutex_;
  Intake intake_;
  std::vector<OwnReader> own_;
  RosReaders ros_;
  DataWait wait_;
  std::size_t waited_for_ = 0;  // of the readers of ROS 2's topics
  std::vector<CdrSample> taken_;
  std::vector<std::uint64_t> ended_;
  SpscRing<PoseBatch> ring_;
  bool lent_ = false;  // the front slot is with the tick
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
