// Compares the daemon's bounds of pairs with a camera with what the camera has truly seen.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"
#include "monitor/interface/mutex.hpp"
#include "tools/rendering/simulated_world.hpp"
#include "tools/robot/simulated_cameras.hpp"

namespace clearance {

// The truth is the visible surface without noise: a point of it for each pixel that was sent. The
// reports name the frame and the joints that they used by their ages. Points that show the robot
// itself, or a body that the camera `knows`, are left out, and so are points in the blind shell of
// one of these: the daemon may have left them out with its image.
class CameraTruth {
 public:
  // `world`: of its own, at the times of the reports. `joint_rate_hz`: of the joints that are sent.
  // Everything outlives this.
  CameraTruth(const Cell& cell, client::Connection& connection, SimulatedWorld world,
              const SimulationTime& time, double joint_rate_hz);
  ~CameraTruth();
  CameraTruth(const CameraTruth&) = delete;
  CameraTruth& operator=(const CameraTruth&) = delete;

  // Called by the thread of the cameras.
  void sent(const SentFrame& frame);

  // Ends the comparison and says what it found, a line for each pair.
  void tell();

 private:
  // The foreign points of a frame.
  struct Frame {
    std::int64_t stamp_ns = 0;
    std::vector<Eigen::Vector3f> points;  // in the world, m
    std::vector<float> sizes;  // m: no element that contains the point extends farther from it
  };
  // The findings for one pair.
  struct Found {
    std::uint64_t compared = 0, above = 0;  // `above`: the truth is outside of the bounds
    double least = kInfinity;               // true distance, m
    double worst = -kInfinity;              // by how much, at most, m
    std::vector<float> gaps;                // truth less lower, m
  };
  // A part of a robot, and the thickness of the shell around it that may have been left out.
  struct OwnPart {
    const Part* part;
    Pose place;  // in the world
    double shell;
    bool is_reported;  // the shell contains whole elements
  };
  using Shells = std::map<std::uint32_t, double>;  // by object, m
  static constexpr std::size_t kKept = 45;         // frames: 1.5 s

  // True for a body whose image the daemon leaves out.
  [[nodiscard]] bool is_left_out(const Sensor& sensor, const SimulatedWorld& world,
                                 std::uint32_t label) const;
  void run();
  void compare(std::uint32_t sensor, const clearance_msg_Distances& report);
  // Pairs of two bodies, at the time of the joints that the report used.
  void compare_bodies(const clearance_msg_Distances& report);
  void compare(const clearance_msg_PairDistance& pair, std::int64_t body_ns,
               const std::vector<Vec3>& points);
  [[nodiscard]] std::optional<Frame> frame_of(std::uint32_t sensor, std::int64_t stamp_ns);
  // The points of the frame that are not in the blind shell of the robots at its stamp.
  [[nodiscard]] std::vector<Vec3> outside_of_shells(const Sensor& sensor, const Frame& frame,
                                                    const Shells& reported);
  // Shells of the report for the object of a sensor.
  [[nodiscard]] Shells shells_of(std::uint32_t seen, const clearance_msg_Distances& report) const;
  [[nodiscard]] static bool is_in_shell(std::span<const OwnPart> parts, const Vec3& point,
                                        double size);
  // The distance of an object to the points, m; infinite without any.
  [[nodiscard]] double distance_to(std::uint32_t object, const std::vector<Vec3>& points) const;

  const Cell& cell_;
  const SimulationTime& time_;
  client::Reports reports_;
  SimulatedWorld world_;
  std::vector<std::uint32_t> known_;  // bodies that the cell knows, in ascending order
  double joint_motion_ = 0.0;         // m: of a link between two joint states, at most
  Mutex mutex_;
  GUARDED_BY(mutex_) std::vector<std::deque<Frame>> frames_;  // by sensor
  std::map<std::uint32_t, Found> found_;                      // by pair
  std::uint64_t unknown_ = 0;  // frames that reports used and that are not kept
  std::size_t most_blind_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
