// Leaves the robots' own image out of a frame, and that of other bodies which the cell knows. Says
// what the frame cannot show near each of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/stated_errors.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/sensors/posture_history.hpp"

namespace clearance {

class OwnImage {
 public:
  // Links, what they carry, and the bodies of known_bodies(). The scene must outlive this.
  explicit OwnImage(const Scene& scene);

  // How many bodies have an entry in SeenCloud::hidden().
  [[nodiscard]] std::size_t bodies() const noexcept { return bodies_.size(); }

  // A frame of the sensor, before any element is left out. The postures are placed at its stamp.
  // Writes the blind shells of SeenCloud::hidden(), too. A link whose pose at the stamp is not
  // known is not left out: its image counts as an obstacle. Neither are elements farther than
  // Sensor::most_shell from where a link is believed to be. Depths are z, or with `along_ray`
  // distances from the sensor. Call refit() afterwards. Returns how many elements are the image of
  // known bodies; 0 if one of these bodies is not where the cell has it.
  std::size_t leave_out(const Sensor& sensor, bool along_ray, const PastPose& place,
                        const PostureHistory& postures, SeenCloud& cloud, SlabBody& body);
  // The places that this frame has not seen, by groups of links, after leave_out(). None: they are
  // not asked for.
  [[nodiscard]] std::span<DepthCloud> unseen(const Sensor& sensor) noexcept;
  // After that: writes the unseen places of SeenCloud::hidden().
  void find_unseen(const Sensor& sensor, const PastPose& place, const PostureHistory& postures,
                   SeenCloud& cloud, SlabBody& body);

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Body {
    std::uint32_t object = 0;
    std::uint32_t robot = kNone, link = 0;  // none: no link
    // A robot with the attached objects that it carries; none: a body of its own, whose shadow is
    // unseen for all links.
    std::uint32_t group = kNone;
  };
  // Allocated for a sensor that asks for it.
  struct Unseen {
    Unseen(const Sensor& sensor, std::size_t groups)
        : clouds(groups, DepthCloud(sensor.columns, sensor.rows)) {
      if (groups > 1 || sensor.knows) others = clouds;
    }
    std::vector<DepthCloud> clouds;  // by group
    // By group: what is seen, less the images of robots that neither carry this group nor stand on
    // it. Empty if there is one group only, and no known body.
    std::vector<DepthCloud> others;
    CloudTracking tracking;
    bool is_built = false;
  };

  // The arguments that are the same for all bodies of a frame.
  struct OfFrame {
    const Sensor& sensor;
    const PastPose& place;
    const PostureHistory& postures;
    SeenCloud& cloud;
    SlabBody& body;
    CentreLimit limit;
  };
  void leave_out(const Body& each, OfFrame& frame, HiddenNear& near);
  [[nodiscard]] static PastPose place_of(const Body& body, const PostureHistory& postures) noexcept;
  // True if one of the robots stands on the other one, or on what that one carries.
  [[nodiscard]] bool hang_together(std::uint32_t group, std::uint32_t other) const noexcept;
  [[nodiscard]] Unseen* of_sensor(const Sensor& sensor) noexcept {
    return unseen_[scene_.objects[sensor.object].sensor].get();
  }
  void find_unseen(const Body& of, const PastPose& past, const PastPose& place, double place_error,
                   SlabBody& body, Unseen& unseen, HiddenNear& near) const;

  const Scene& scene_;
  StatedErrors errors_;
  std::vector<Body> bodies_;                     // in ascending order of objects
  std::vector<std::uint32_t> groups_;            // the robot of each
  std::vector<std::unique_ptr<Unseen>> unseen_;  // by sensor; null: not asked for
};

}  // namespace clearance
