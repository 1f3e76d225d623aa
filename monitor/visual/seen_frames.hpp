// Frames of the cell's sensors for viewers. Each is made of the same messages as the daemon's, with
// fewer points and less often.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/intake/sensor_messages.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

class Sensors;
struct BuiltFrame;
struct SensorFrame;

// The last frame of a sensor, and what came of its messages.
struct SeenState {
  std::uint32_t object = 0;
  std::int64_t stamp_ns = 0;              // 0: no frame yet
  std::optional<Pose> world_from_sensor;  // at that stamp
  std::size_t elements = 0;               // that queries meet
  std::uint64_t frames = 0;
  std::vector<std::pair<std::string, std::uint64_t>> refused;  // messages, by cause
  // By link: anything within this of it may have been left out with the robot's own image, m.
  std::vector<std::pair<std::uint32_t, double>> shells;
};

class SeenFrames {
 public:
  static constexpr std::int64_t kLeastIntervalNs = 150'000'000;  // between two frames of a sensor
  static constexpr std::size_t kMostPoints = 8000;               // of a frame

  // `is_log`: see IntakeOptions. The cell must outlive this.
  SeenFrames(const Cell& cell, bool is_log);
  ~SeenFrames();
  // The cell is another one.
  void change(const Cell& cell);

  // Poses and joints as viewers take them. They place the sensors and the robot at the stamps.
  void hear(const PoseBatch& batch);
  // A frame that comes too soon is left out. `now_ns`: of any clock, always the same one.
  void hear(const RawSensorMessage& message, std::int64_t now_ns);

  // The publishers that still exist; sorted.
  void keep(std::span<const std::uint64_t> writers);

  // Receives a message of kSeenTopic. The bytes are valid during the call.
  using Use = std::function<void(std::uint32_t sensor, std::int64_t stamp_ns,
                                 std::span<const std::byte> cdr)>;
  // Hands on the frames that can be made now.
  void settle(std::int64_t now_ns, const Use& use);
  // Hands on a frame that a daemon has built, if it is of this cell.
  void show(const BuiltFrame& built, const Use& use);
  [[nodiscard]] std::vector<SeenState> states() const;  // by sensor

 private:
  struct Shown {
    std::int64_t stamp_ns = 0;
    std::optional<Pose> world_from_sensor;
  };

  void hand_on(std::uint32_t sensor, const SensorFrame& frame, const Use& use);

  const Cell* cell_;
  SourceNumbers numbers_;
  std::unique_ptr<Sensors> sensors_;
  std::vector<PoseSample> poses_;
  std::vector<JointSample> joints_;
  std::map<std::string, std::int64_t> heard_ns_;  // by topic of frames
  std::vector<Shown> shown_;                      // by sensor
  CdrEncoder encoder_;
};

}  // namespace clearance
