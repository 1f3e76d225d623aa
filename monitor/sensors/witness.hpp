// A camera as a second witness: does it see each robot where its joints say?
//
// Where the model, shrunk by all errors that are stated or known, is in a pixel's ray, the true
// robot is, too. So a pixel whose depth is beyond that place sees through the robot: its joints,
// its model, or the place of the camera are not as stated. Pixels without depth, and things in
// front of the robot, prove nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/stated_errors.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/interface/robots_seen.hpp"
#include "monitor/sensors/posture_history.hpp"

namespace clearance {

// How many rays of a picture met a robot.
struct RaysOfRobot {
  std::uint32_t agreeing = 0;  // depth as the model allows
  std::uint32_t through = 0;   // depth behind where the robot must be
};

class Witness {
 public:
  // Rays in a picture, at most; they are spread evenly.
  static constexpr std::uint32_t kRays = 4096;
  // Fewer rays that meet a robot say nothing of it.
  static constexpr std::uint32_t kLeastRays = 24;

  // The scene must outlive it.
  explicit Witness(const Scene& scene);

  // A picture at its stamp, at which the postures are placed. Allocates nothing.
  [[nodiscard]] RobotsSeen judge(const Sensor& sensor, const PinholeCamera& camera,
                                 const DepthImage& image, const PastPose& place,
                                 const PostureHistory& postures) noexcept;
  // Of the last picture, by robot.
  [[nodiscard]] const std::vector<RaysOfRobot>& rays() const noexcept { return rays_; }

 private:
  // The rays in the last picture, as indices of columns and rows of the coarse grid.
  struct Grid {
    std::uint32_t step = 1, columns = 0, rows = 0;
  };
  void meet(const Part& part, const RelativePose& camera_from_part, double shrunk_by,
            const PinholeCamera& camera);
  void count(std::uint32_t robot, const Sensor& sensor, const DepthImage& image) noexcept;

  const Scene& scene_;
  StatedErrors errors_;
  Grid grid_;
  // By ray, of the robot that is looked at: where its shrunk bodies begin, and where it may begin
  // at the nearest, m.
  std::vector<float> surest_, nearest_;
  std::vector<RaysOfRobot> rays_;
};

}  // namespace clearance
