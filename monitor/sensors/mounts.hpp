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
#include "monitor/intake/raw_message.hpp"
#include "monitor/intake/tf_frames.hpp"
#include "monitor/sensors/mount_track.hpp"
#include "monitor/sensors/posture_history.hpp"

namespace clearance {

class Mounts {
 public:
  // The transforms of a frame that are kept.
  static constexpr std::size_t kKeptTransforms = 256;

  // The cell must outlive this.
  explicit Mounts(const Cell& cell);
  // The cell has changed: tracks of frames that stood in the world go on.
  void take_over(Mounts& before);

  // Judges the places of all sensors on tf. Call this after each message of transforms.
  void judge(const TfFrames& frames, const Now& now);
  // The same for one sensor, before its frame is built.
  void judge(const Sensor& sensor, const std::string& frame, const TfFrames& frames,
             const Now& now);
  // This machine's clock was set back.
  void forget();

  // The pose of the sensor at the stamp. `frame` is the one that the message names. The caller has
  // called place() of `postures` for the stamp.
  // The path of frames ends at the first one that is a link, the frame of an object or the world of
  // the cell. Joints place the links, whatever tf says of them. The name of an object is no frame,
  // because its origin may be elsewhere. The pose is unknown if the path leads nowhere, or if its
  // end has no pose at that time. It is also unknown if the transforms end before the stamp and the
  // mount states no speed, and while the path is where the frame cannot have got to (MountTrack).
  [[nodiscard]] PastPose find(const Sensor& sensor, const std::string& frame, std::int64_t stamp_ns,
                              const TfFrames& frames, const PostureHistory& postures) const;
  // The carrier of the sensor at that stamp.
  [[nodiscard]] Carrier carrier(const Sensor& sensor, const std::string& frame,
                                std::int64_t stamp_ns, const TfFrames& frames) const;
  // Compares where tf and the cell place each robot that the cell fixes in the world. If they
  // differ, a camera that tf places in the world, or on an object, is elsewhere as seen from that
  // robot. Returns a sentence if they differ by more than 10 mm or 10 mrad. Otherwise adds the
  // displacement of the camera to the errors of `place`, its pose, and returns "". A camera whose
  // path ends at a link is not compared, since the cell alone places it.
  [[nodiscard]] std::string robot_elsewhere(const Sensor& sensor, const std::string& frame,
                                            std::int64_t stamp_ns, const TfFrames& frames,
                                            PastPose& place) const;
  // True if the path leads to a place, and its last transforms are from before the stamp, but no
  // older than kSourceSilentNs: later ones may still come.
  [[nodiscard]] bool awaits_transforms(const Sensor& sensor, const std::string& frame,
                                       std::int64_t stamp_ns, const TfFrames& frames) const;

 private:
  // By which frames a sensor stands, from its own one on.
  struct Path {
    bool leads = false;                          // to what the cell has; if not, it leads nowhere
    Carrier carrier;                             // what the cell has at its end
    std::vector<const TfFrames::Claim*> claims;  // from the sensor to the carrier
    std::vector<std::string> children;           // of these
    // The stamp of the last transform; for several frames, the earliest of these stamps.
    std::int64_t known_until_ns = std::numeric_limits<std::int64_t>::max();

    [[nodiscard]] bool is_static() const noexcept {
      return known_until_ns == std::numeric_limits<std::int64_t>::max();
    }
  };
  // A claim in the place of the one that is used.
  struct Instead {
    const std::string& child;
    const TfFrames::Claim& claim;
  };
  using Tracks = std::map<std::string, MountTrack>;  // by frame

  [[nodiscard]] static const std::string& frame_of(const Sensor& sensor,
                                                   const std::string& frame) noexcept {
    return sensor.frames_by_message ? frame : sensor.mount.frame;
  }
  [[nodiscard]] Path path_of(const std::string& frame, std::int64_t stamp_ns,
                             const TfFrames& frames, const Instead* instead = nullptr) const;
  [[nodiscard]] static PastPose base_of(const Carrier& carrier, const PostureHistory& postures);
  void judge(const std::string& frame, const TfFrames& frames, const Now& now,
             MountTrack& track) const;
  void judge_at(std::int64_t stamp_ns, const std::string& frame, const TfFrames& frames,
                std::int64_t now_ns, MountTrack& track) const;
  void judge_rivals(const std::string& frame, const Path& used, const TfFrames& frames,
                    const Now& now, MountTrack& track) const;
  [[nodiscard]] const MountTrack* track_of(const Sensor& sensor, const std::string& frame) const;
  // The place at the end of the path whose base is at `place`. Nothing if a frame has no place.
  struct PathPlace {
    PastPose place;
    std::int64_t longest_ns = 0;  // between two transforms of a frame
  };
  [[nodiscard]] static std::optional<PathPlace> along(const Path& path, PastPose place,
                                                      std::int64_t stamp_ns,
                                                      std::int64_t within_ns);
  // The distance of the path at this time from where along() has it, by the stated speeds since
  // the transforms before it and until those after it; nothing: not known.
  [[nodiscard]] static std::optional<MountTrack::Excess> deviation_in_gap(const MountSpeed& speed,
                                                                          const Path& path,
                                                                          std::int64_t stamp_ns);
  [[nodiscard]] PastPose of_frame(const Sensor& sensor, const std::string& frame,
                                  std::int64_t stamp_ns, const TfFrames& frames,
                                  const PostureHistory& postures) const;
  // Follows the path from this frame up to one of the cell.
  void climb(std::string at, std::int64_t stamp_ns, const TfFrames& frames, const Instead* instead,
             Path& path) const;
  // Writes the carrier of the path, if the frame is one of the cell.
  void find_carrier(const std::string& frame, Path& path) const;

  const Cell& cell_;
  std::string world_;                                                     // the frame of tf
  std::map<std::string, std::pair<std::uint32_t, std::uint32_t>> links_;  // robot and link
  std::map<std::string, std::uint32_t> objects_;                          // by their frames
  struct FixedRoot {
    std::string frame;
    Pose world_from_root;
  };
  std::vector<FixedRoot> fixed_roots_;  // of robots
  std::vector<Tracks> tracks_;          // by sensor
};

}  // namespace clearance
