// The place of a sensor in the world at the stamp of a frame.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/cell.hpp"
#include "config/scene/carrier.hpp"
#include "monitor/sensors/frame_history.hpp"
#include "monitor/sensors/posture_history.hpp"

namespace clearance {

class Mounts {
 public:
  // The cell must outlive this.
  explicit Mounts(const Cell& cell);

  // The pose of the sensor at the stamp. `frame` is the one that the message names. The caller has
  // called place() of `postures` for the stamp.
  // The path of frames ends at the first one that is a link, the frame of an object or the world of
  // the cell. Joints place the links, whatever tf says of them. The name of an object is no frame,
  // because its origin may be elsewhere. The pose is unknown if the path leads nowhere, or if its
  // end has no pose at that time. It is also unknown if the transforms end before the stamp and the
  // mount states no speed. It stays unknown for a second after the path has jumped farther than the
  // speed allows. Without a stated speed, 5 m/s and 6.3 rad/s count.
  [[nodiscard]] PastPose find(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                              const FrameHistory& frames, const PostureHistory& postures) const;
  // The carrier of the sensor at that stamp.
  [[nodiscard]] Carrier carrier(const Sensor& sensor, const std::string& frame,
                                std::int64_t stamp_ns, const FrameHistory& frames,
                                const PostureHistory& postures) const;
  // Compares where tf and the cell place each robot that the cell fixes in the world. If they
  // differ, a camera that tf places in the world, or on an object, is elsewhere as seen from that
  // robot. Returns a sentence if they differ by more than 10 mm or 10 mrad. Otherwise adds the
  // displacement of the camera to the errors of `place`, its pose, and returns "". A camera whose
  // path ends at a link is not compared, since the cell alone places it.
  [[nodiscard]] std::string robot_elsewhere(const Sensor& sensor, const std::string& frame,
                                            std::int64_t stamp_ns, const FrameHistory& frames,
                                            const PostureHistory& postures, PastPose& place) const;
  // True if the path leads to a place, and its last transforms are from before the stamp, but no
  // older than FrameHistory::kLostNs: later ones may still come.
  [[nodiscard]] bool awaits_transforms(const Sensor& sensor, const std::string& frame,
                                       std::int64_t stamp_ns, const FrameHistory& frames,
                                       const PostureHistory& postures) const;

 private:
  struct Path {
    std::optional<PastPose> base;     // what carries the frames; none: the path leads nowhere
    Carrier carrier;                  // the same, for the tick
    std::vector<std::string> frames;  // from the sensor to the base
    // The stamp of the last transform; for several frames, the earliest of these stamps.
    std::int64_t known_until_ns = std::numeric_limits<std::int64_t>::max();
  };

  [[nodiscard]] Path path_of(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                             const FrameHistory& frames, const PostureHistory& postures) const;
  // The excess of the whole path's motion, between transforms of the last second, over what the
  // stated speeds allow. Without them, 5 m/s and 6.3 rad/s count. Returns nothing if wrong stamps
  // cannot explain the excess.
  struct Excess {
    double shift = 0.0, turn = 0.0;  // m, rad
  };
  [[nodiscard]] std::optional<Excess> excess(const Sensor& sensor, const Path& path,
                                             std::int64_t last_ns,
                                             const FrameHistory& frames) const;
  // The place at the end of the path whose base is at `place`. Nothing if a frame has no place.
  struct PathPlace {
    PastPose place;
    std::int64_t longest_ns = 0;  // between two transforms of a frame
  };
  [[nodiscard]] static std::optional<PathPlace> along(const Path& path, PastPose place,
                                                      std::int64_t stamp_ns, std::int64_t within_ns,
                                                      const FrameHistory& frames);
  // The distance of the path at this time from where along() has it, by the stated speeds since
  // the transforms before it and until those after it; nothing: not known.
  [[nodiscard]] static std::optional<Excess> deviation_in_gap(const MountSpeed& speed,
                                                              const Path& path,
                                                              std::int64_t stamp_ns,
                                                              const FrameHistory& frames);
  [[nodiscard]] PastPose of_frame(const Sensor& sensor, const std::string& frame,
                                  std::int64_t stamp_ns, const FrameHistory& frames,
                                  const PostureHistory& postures) const;
  // Follows the path from this frame up to one of the cell.
  void climb(std::string at, std::int64_t stamp_ns, const FrameHistory& frames,
             const PostureHistory& postures, Path& path) const;
  // Writes the base and the carrier of the path, if the frame is one of the cell.
  void find_base(const std::string& frame, const PostureHistory& postures, Path& path) const;

  const Cell& cell_;
  std::string world_;                                                     // the frame of tf
  std::map<std::string, std::pair<std::uint32_t, std::uint32_t>> links_;  // robot and link
  std::map<std::string, std::uint32_t> objects_;                          // by their frames
  struct FixedRoot {
    std::string frame;
    Pose world_from_root;
  };
  std::vector<FixedRoot> fixed_roots_;  // of robots
};

}  // namespace clearance
