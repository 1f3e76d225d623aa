// Leaves the robots' own image out of a frame, and says what the frame cannot show near each link.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/sensors/posture_history.hpp"

namespace clearance {

class OwnImage {
 public:
  // Links, and what they carry. The scene must outlive this.
  explicit OwnImage(const Scene& scene);

  [[nodiscard]] std::size_t links() const noexcept { return links_.size(); }

  // A frame of the sensor, before any element is left out. The postures are placed at its stamp.
  // Writes the blind shells of SeenCloud::hidden(), too. A link whose pose at the stamp is not
  // known is not left out: its image counts as an obstacle. Neither are elements farther than
  // Sensor::most_shell from where a link is believed to be. Call refit() afterwards.
  void leave_out(const Sensor& sensor, const PastPose& place, const PostureHistory& postures,
                 SeenCloud& cloud, SlabBody& body);
  // The places that this frame has not seen, by groups of links, after leave_out(). None: they are
  // not asked for.
  [[nodiscard]] std::span<DepthCloud> unseen(const Sensor& sensor) noexcept;
  // After that: writes the unseen places of SeenCloud::hidden().
  void find_unseen(const Sensor& sensor, const PastPose& place, const PostureHistory& postures,
                   SeenCloud& cloud, SlabBody& body);

 private:
  struct Link {
    std::uint32_t object = 0, robot = 0, link = 0;
    std::uint32_t group = 0;  // a robot with the attached objects that it carries
  };
  // Allocated for a sensor that asks for it.
  struct Unseen {
    Unseen(const Sensor& sensor, std::size_t groups)
        : clouds(groups, DepthCloud(sensor.columns, sensor.rows)) {
      if (groups > 1) others = clouds;
    }
    std::vector<DepthCloud> clouds;  // by group
    // By group: what is seen, without the images of robots that do not hang together with it. Empty
    // if there is one group only.
    std::vector<DepthCloud> others;
    CloudTracking tracking;
    bool is_built = false;
  };

  // True if one of the robots stands on the other one, or on what that one carries.
  [[nodiscard]] bool hang_together(std::uint32_t group, std::uint32_t other) const noexcept;
  [[nodiscard]] Unseen* of_sensor(const Sensor& sensor) noexcept {
    return unseen_[scene_.objects[sensor.object].sensor].get();
  }
  void find_unseen(const Link& of, const PastPose& past, const PastPose& place, double place_error,
                   SlabBody& body, Unseen& unseen, HiddenNear& near) const;

  const Scene& scene_;
  std::vector<Link> links_;                      // in ascending order of objects
  std::vector<std::uint32_t> groups_;            // the robot of each
  std::vector<std::unique_ptr<Unseen>> unseen_;  // by sensor; null: not asked for
};

}  // namespace clearance
