// The PoseSource of DDS: it reads poses, joint states and tf, from our own topics and those of ROS
// 2. Its thread takes samples, has them decoded and admitted (intake/), and hands batches to the
// tick thread. The sensors of the cell have another thread (sensor_reader.hpp), which gets the same
// batches.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/name_limit.hpp"
#include "monitor/dds/ros_readers.hpp"
#include "monitor/dds/sensor_reader.hpp"
#include "monitor/intake/intake.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/tick/spsc_ring.hpp"

namespace clearance {

// The tick thread calls next(), which takes no lock. Other threads call everything else.
class PoseReader final : public PoseSource {
 public:
  // The largest numbers of poses and of joints in a batch. More are counted and not used.
  [[nodiscard]] static std::size_t samples_a_batch(const Cell& cell) noexcept;
  [[nodiscard]] static std::size_t joints_a_batch(const Cell& cell) noexcept;
  // The number of batches that may wait for one tick.
  static constexpr std::size_t kBatches = 128;

  // The participant must outlive this, and the cell until change() is called. `use_scene` gets
  // MoveIt's messages, in the thread that takes samples. `time` as IntakeOptions::time.
  PoseReader(const Cell& cell, Participant& participant, MoveItMessages::Use use_scene = {},
             SimulatedTime* time = nullptr);
  ~PoseReader() override;

  // Starts the threads that take samples. Call this once, when ticks are about to begin: what
  // arrives earlier would only fill the ring.
  void start();

  // The cell has changed: batches have the ids and the revision of this one from now on. It needs
  // no topic that the cell before did not need, and no larger batches. It must outlive this.
  void change(const Cell& cell);

  const PoseBatch* next() noexcept override;
  // For the tick thread: frames of sensors; null if the cell has none.
  [[nodiscard]] FrameExchange* frames() noexcept {
    return sensors_ ? &sensors_->frames() : nullptr;
  }

  // After start(): the thread that takes.
  [[nodiscard]] std::thread::native_handle_type thread() { return thread_.native_handle(); }

  // For any thread but that of the tick.
  [[nodiscard]] std::vector<SourceTally> tallies() const;
  [[nodiscard]] std::vector<RefusedSource> refused_sources() const;
  // The sum of the counts of sources that have given up their places.
  [[nodiscard]] SourceTally departed() const;
  // The number of samples refused because their writers use more names than NameLimit allows.
  [[nodiscard]] std::uint64_t refused_names() const { return names_.refused(); }
  // Before start(): builds the same frames of sensors as the partner, until end_sharing().
  void share_frames(const Topics& topics, const DaemonIdentity& identity,
                    const TickPartner& ticks) {
    if (sensors_) sensors_->share_frames(topics, identity, ticks);
  }
  void end_sharing() {
    if (sensors_) sensors_->end_sharing();
  }
  // Before start(): keeps the frames of sensors for a recording. Null: the cell has none.
  [[nodiscard]] BuiltFrames* keep_frames() {
    if (sensors_) sensors_->keep_frames();
    return sensors_ ? &sensors_->built() : nullptr;
  }
  // Any thread: see SensorReader::copies().
  [[nodiscard]] std::vector<SeenFrame> seen(std::uint64_t scene_revision) {
    return sensors_ ? sensors_->copies(scene_revision) : std::vector<SeenFrame>();
  }
  // By sensor of the cell.
  [[nodiscard]] std::vector<SensorStatus> sensors() const {
    return sensors_ ? sensors_->statuses() : std::vector<SensorStatus>();
  }
  // The number of samples that Cyclone could not decode since this object was made. Cyclone drops
  // them with a line in its log, where they are counted. The count includes other readers of the
  // process.
  [[nodiscard]] std::uint64_t undecodable() const;
  // A sentence for a person who hears nothing of a robot. It names the senders of joint states. If
  // there are none, it names the topics that exist instead.
  [[nodiscard]] std::string senders_of_joints() const;

 private:
  // One of our own topics.
  struct OwnReader {
    dds_entity_t handle;
    std::uint32_t topic;
  };

  void open(Participant& participant, TopicKind kind) REQUIRES(mutex_);
  void run();
  void poll() REQUIRES(mutex_);
  void note_writers() REQUIRES(mutex_);
  void take_all(const Now& now) REQUIRES(mutex_);
  bool hand_over(PoseBatch& batch) noexcept;
  void log_news() REQUIRES(mutex_);
  [[nodiscard]] std::string guid_of(std::uint64_t writer) const REQUIRES(mutex_);

  GUARDED_BY(mutex_) const Topics* topics_;
  std::uint64_t undecodable_before_;
  NameLimit names_;
  std::atomic<bool> writers_changed_{false};
  std::string where_, partition_;
  // The taking and the publishing thread use it, never the tick thread.
  mutable Mutex mutex_;
  std::unique_ptr<SensorReader> sensors_;  // null: the cell has none
  GUARDED_BY(mutex_) Intake intake_;
  std::vector<OwnReader> own_;
  GUARDED_BY(mutex_) RosReaders ros_;
  DataWait wait_;
  std::size_t waited_for_ = 0;  // number of readers of ROS 2's topics in `wait_`
  std::vector<CdrSample> taken_;
  std::vector<std::uint64_t> ended_;
  SpscRing<PoseBatch> ring_;
  bool lent_ = false;  // the tick is using the front slot
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
