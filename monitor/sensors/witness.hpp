// A camera as a second witness: does it see each robot where its joints say?
//
// Where the model, shrunk by all errors that are stated or known, is in a pixel's ray, the true
// robot is, too. So a pixel whose depth is beyond that place sees through the robot: its joints,
// its model, or the place of the camera are not as stated. Pixels without depth, and things in
// front of the robot, prove nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/stated_errors.hpp"
#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/interface/robots_seen.hpp"
#include "monitor/sensors/posture_history.hpp"

namespace clearance {

// The rays of a picture that met a robot.
struct RaysOfRobot {
  std::uint32_t agreeing = 0;  // depth as the model allows
  std::uint32_t through = 0;   // depth behind where the robot must be
  // Of the rays that agree, m: how far the measured point is behind the surface that the joints
  // place, along the surface's normal. The median, and the 90 % quantile of the absolute value.
  // NaN: no ray that agrees met a part whose surface is known exactly.
  double residual_p50 = std::numeric_limits<double>::quiet_NaN();
  double residual_p90 = residual_p50;
};

class Witness {
 public:
  // Rays for a robot in a picture, at most; they are spread evenly over where it may be.
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
  // Columns from left to before right, and rows likewise.
  struct Pixels {
    std::uint32_t left = 0, right = 0, top = 0, bottom = 0;
    [[nodiscard]] bool is_empty() const noexcept { return left >= right || top >= bottom; }
  };
  // A part that may be in the picture. `error`: no point of its true surface is farther from it, m.
  struct Placed {
    const Part* part = nullptr;
    RelativePose camera_from_part;
    double error = 0.0;
    Pixels pixels;
  };
  // The rays: every `step`-th pixel from the upper left one on.
  struct Grid {
    std::uint32_t left = 0, top = 0, step = 1, columns = 0, rows = 0;
  };
  // The depths at which a ray comes to a robot, m: its shrunk bodies, the nearest place where it
  // may begin, and its bodies as stated. A metre of depth leads `slope` metres into the stated
  // surface, along its normal; 0: the surface is not known exactly.
  struct Ray {
    float surest = kNowhere, nearest = kNowhere, stated = kNowhere, slope = 0.0F;
  };
  static constexpr float kNowhere = std::numeric_limits<float>::infinity();
  [[nodiscard]] static Pixels pixels_around(const Vec3& centre, double radius,
                                            const PinholeCamera& camera) noexcept;
  void place_parts(std::uint32_t r, const Sensor& sensor, const PinholeCamera& camera,
                   const PastPose& place, const PostureHistory& postures) noexcept;
  void spread_rays() noexcept;
  void meet(const Placed& placed, const PinholeCamera& camera) noexcept;
  [[nodiscard]] RaysOfRobot count(const Sensor& sensor, const DepthImage& image) noexcept;
  void measure(RaysOfRobot& rays) noexcept;

  const Scene& scene_;
  StatedErrors errors_;
  std::vector<Placed> placed_;  // of the robot that is looked at
  Grid grid_;
  std::vector<Ray> met_;           // of the robot that is looked at
  std::vector<float> residuals_;   // of that robot's rays that agree, m
  std::vector<RaysOfRobot> rays_;  // by robot
};

}  // namespace clearance
