// The cameras of a cell: renders what they see and sends it as ROS 2 does, in a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/camera_types.hpp"
#include "tools/rendering/depth_renderer.hpp"
#include "tools/rendering/measured_depth.hpp"
#include "tools/rendering/simulated_world.hpp"
#include "tools/robot/simulation_time.hpp"

namespace clearance {

struct SimulatedCameraOptions {
  double rate_hz = 30.0;
  std::uint32_t columns = 320, rows = 240;
  double noise_share = 0.9;     // of the depth_error that the cell states
  double missing_share = 0.01;  // of the pixels
};

// One frame as it was sent, and what it shows in truth. Valid during the call.
struct SentFrame {
  std::uint32_t sensor = 0;
  std::int64_t stamp_ns = 0;
  double t_s = 0.0;
  const SimulatedWorld& world;  // placed at that time
  Pose world_from_sensor;
  const rendering::DepthRenderer& truth;
  const std::vector<bool>& is_sent;  // by pixel: it is not missing
};

// Returns what is wrong with the options for this cell's sensors; empty: nothing. A sensor
// without a place (has_place) cannot be simulated.
[[nodiscard]] std::string fault_of(const Cell& cell, const SimulatedCameraOptions& options);

class SimulatedCameras {
 public:
  using Watch = std::function<void(const SentFrame& frame)>;

  // Everything outlives this. `watch` may be empty; it is called in the thread of the cameras.
  SimulatedCameras(const Cell& cell, Participant& participant, SimulatedWorld world,
                   const SimulationTime& time, const SimulatedCameraOptions& options, Watch watch);
  ~SimulatedCameras();
  SimulatedCameras(const SimulatedCameras&) = delete;
  SimulatedCameras& operator=(const SimulatedCameras&) = delete;

  // Ends the thread; the figures below are complete after that.
  void stop();
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }
  // Delays of a frame of one camera: from its stamp until it is rendered, and until it is written.
  [[nodiscard]] const Histogram& rendered() const noexcept { return rendered_; }
  [[nodiscard]] const Histogram& written() const noexcept { return written_; }

 private:
  struct Camera;

  void run();
  void expose(Camera& camera, std::int64_t monotonic_ns);
  void measure(Camera& camera);
  void write_image(Camera& camera, std::int64_t stamp_ns);
  void write_points(Camera& camera, std::int64_t stamp_ns);
  void count(dds_return_t written);

  const SimulationTime& time_;
  SimulatedCameraOptions options_;
  Watch watch_;
  SimulatedWorld world_;
  std::vector<std::unique_ptr<Camera>> cameras_;
  std::vector<double> measured_;  // along the ray, of sensors whose depth is that
  std::uint64_t frame_ = 0;
  std::uint64_t sent_ = 0, failed_ = 0;
  Histogram rendered_, written_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace clearance
