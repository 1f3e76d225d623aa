// Reads the sensors of a cell from DDS, and makes their frames for the tick.
//
// A thread takes images, CameraInfo, points and transforms, and builds a frame of the newest of
// them. It has readers of its own, so that no joint or pose waits behind an image, and ordinary
// priority. The tick takes a frame when it is built (tick/frame_exchange.hpp).
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/dds/partner_frames.hpp"
#include "monitor/dds/ros_readers.hpp"
#include "monitor/inputs/scene_ids.hpp"
#include "monitor/intake/intake.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/interface/question.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/sensors/sensors.hpp"
#include "monitor/tick/frame_exchange.hpp"
#include "monitor/tick/spsc_ring.hpp"

namespace clearance {

class SensorReader {
 public:
  // Allocates the memory of all clouds. The participant must outlive this, and the cell until
  // change() is called. `time` as IntakeOptions::time.
  SensorReader(const Cell& cell, Participant& participant, SimulatedTime* time = nullptr);
  ~SensorReader();
  SensorReader(const SensorReader&) = delete;
  SensorReader& operator=(const SensorReader&) = delete;

  // Before start(): keeps the frames that are built for a recording.
  void keep_frames() { records_ = true; }
  // Before start(): builds the same frames as the partner. `ticks` and `identity` must outlive
  // this, or end_sharing() be called before.
  void share_frames(const Topics& topics, const DaemonIdentity& identity, const TickPartner& ticks);
  void end_sharing();
  [[nodiscard]] BuiltFrames& built() noexcept { return built_; }
  // Starts the thread. Call this once.
  void start();
  // The loop ticks another cell, with the same sensors but for what they state of their places and
  // errors. Waits until a frame that is being built is done. The cell must outlive this.
  void change(const Cell& cell);

  // For one thread, that which takes poses and joints: a batch that the tick will get. A batch that
  // finds no free slot is left out: places are then known less well.
  void note(const PoseBatch& batch);

  // For the tick.
  [[nodiscard]] FrameExchange& frames() noexcept { return frames_; }

  // Any thread, for questions about motions: copies of the last frames of the scene of this
  // revision, each under the name of its sensor. A frame is copied once. `age` is left to the
  // caller.
  [[nodiscard]] std::vector<SeenFrame> copies(std::uint64_t scene_revision);

  // Any thread: as of the last frame or second.
  [[nodiscard]] std::vector<SensorStatus> statuses() const;

 private:
  void run();
  // The present time, in which messages are stamped.
  [[nodiscard]] std::int64_t time_ns() const noexcept;
  void poll() REQUIRES(mutex_);
  void forget_other_run() REQUIRES(mutex_);
  void take_all() REQUIRES(mutex_);
  void build() REQUIRES(mutex_);
  void build_own() REQUIRES(mutex_);
  void build_shared() REQUIRES(mutex_);
  void keep(BuiltFrame frame) REQUIRES(mutex_);
  [[nodiscard]] bool is_used(const SeenCloud* cloud) const noexcept REQUIRES(mutex_);
  void use(std::uint32_t sensor, SensorFrame frame) REQUIRES(mutex_);
  void tell_of_no_memory() REQUIRES(mutex_);
  void log_news() REQUIRES(mutex_);
  void tell_of_silence() REQUIRES(mutex_);
  void tell_of_shells() REQUIRES(mutex_);
  void tell_of_robots() REQUIRES(mutex_);
  void tell_of_payloads() REQUIRES(mutex_);
  [[nodiscard]] std::string why_silent(const Sensor& sensor, const SensorStatus& status) const
      REQUIRES(mutex_);

  GUARDED_BY(mutex_) const Cell* cell_;
  Participant& participant_;
  SimulatedTime* time_;
  GUARDED_BY(mutex_) std::uint64_t resets_ = 0;  // of that time
  FrameExchange frames_;
  BuiltFrames built_;
  struct NotedBatch {
    PoseBatch batch;
    std::int64_t came_ns = 0;  // as of time_ns()
  };
  SpscRing<NotedBatch> batches_;
  bool records_ = false;
  std::int64_t started_ns_ = 0;  // CLOCK_MONOTONIC; for the thread
  Mutex mutex_;
  GUARDED_BY(mutex_) SceneIds ids_;
  GUARDED_BY(mutex_) std::unique_ptr<Sensors> sensors_;
  GUARDED_BY(mutex_) Intake intake_;
  GUARDED_BY(mutex_) RosReaders ros_;
  DataWait wait_;
  GUARDED_BY(mutex_) std::size_t waited_for_ = 0;  // number of readers of ROS 2's topics in `wait_`
  GUARDED_BY(mutex_) std::vector<CdrSample> taken_;
  GUARDED_BY(mutex_) std::vector<PoseSample> poses_;
  GUARDED_BY(mutex_) std::vector<JointSample> joints_;
  GUARDED_BY(mutex_) std::int64_t now_ns_ = 0;        // CLOCK_MONOTONIC
  GUARDED_BY(mutex_) std::int64_t no_memory_ns_ = 0;  // when the log last told of it; 0: never
  std::string where_;
  GUARDED_BY(mutex_) std::vector<bool> silence_said_;    // by sensor
  GUARDED_BY(mutex_) std::vector<bool> is_shell_thick_;  // by sensor, as it was said
  // By sensor and robot, or SensorStatus::payloads, as it was said.
  GUARDED_BY(mutex_) std::vector<std::vector<bool>> is_denied_, carries_;
  // The last frame of a sensor, whose cloud stays as it is while mutex_ is held; and its copy.
  struct Last {
    SensorFrame frame;
    std::uint64_t scene_revision = 0;
    std::shared_ptr<const SeenCloud> copy;  // null: not copied yet
  };
  GUARDED_BY(mutex_) std::vector<Last> last_;                  // by sensor
  GUARDED_BY(mutex_) std::unique_ptr<PartnerFrames> partner_;  // null: the daemon has none
  GUARDED_BY(mutex_) FrameNames names_;
  GUARDED_BY(mutex_) std::uint64_t content_ = 0;  // of the frame that is built
  GUARDED_BY(mutex_) bool is_shared_ = false;     // that frame is one of the partner
  // Frames of the partner that are to be built.
  struct Sent {
    std::uint64_t content = 0;  // 0: none
    BuiltFrame frame;
  };
  GUARDED_BY(mutex_) std::vector<Sent> sent_;  // by sensor
  mutable Mutex status_mutex_;
  GUARDED_BY(status_mutex_) std::vector<SensorStatus> statuses_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
