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
  // `any_root`: without a world_frame, the root of all frames is taken to be the world, as in a
  // log. The cell must outlive this.
  Mounts(const Cell& cell, bool any_root);

  // The pose of the sensor. `frame` is the one that the message names; `postures` are placed at the
  // stamp. A path of frames ends at the first one that is a link, an object or the world of the
  // cell: links are placed by their joints, whatever tf says of them. Not known: the path leads
  // nowhere, or to what has no pose at that time, or its transforms end before the stamp. In the
  // last case, a stated speed of the mount gives a pose all the same. A path whose transforms have
  // jumped farther than that speed allows, or than 5 m/s and 6.3 rad/s do, is not known for a
  // second.
  [[nodiscard]] PastPose find(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                              const FrameHistory& frames, const PostureHistory& postures) const;
  // The carrier of the sensor at that stamp.
  [[nodiscard]] Carrier carrier(const Sensor& sensor, const std::string& frame,
                                std::int64_t stamp_ns, const FrameHistory& frames,
                                const PostureHistory& postures) const;
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
    // The first of the last transforms.
    std::int64_t known_until_ns = std::numeric_limits<std::int64_t>::max();
  };

  [[nodiscard]] Path path_of(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                             const FrameHistory& frames, const PostureHistory& postures) const;
  // The way of the whole path between its transforms of the last second beyond the stated
  // speeds, or those that no mount exceeds; nothing: farther than wrong stamps explain.
  struct Excess {
    double shift = 0.0, turn = 0.0;  // m, rad
  };
  [[nodiscard]] std::optional<Excess> excess(const Sensor& sensor, const Path& path,
                                             std::int64_t last_ns,
                                             const FrameHistory& frames) const;
  // The place at the end of the path, whose base is at `place`; nothing: a frame has none.
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
  // Writes the base and the carrier of the path, if the frame is one of the cell.
  void find_base(const std::string& frame, const PostureHistory& postures, Path& path) const;

  const Cell& cell_;
  bool any_root_;
  std::map<std::string, std::pair<std::uint32_t, std::uint32_t>> links_;  // robot and link
  std::map<std::string, std::uint32_t> objects_;                          // by their frames
};

}  // namespace clearance
