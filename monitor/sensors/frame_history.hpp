// The transforms of tf over time: where a frame was at the stamp of an image.
//
// Between two transforms of a frame, its place is on the straight way between them. The frame is
// taken to be within the ball whose diameter is that way, since tf states no speed: it may begin to
// move, or stop, at any time in between. After the last transform, its place is not known.
//
// A frame belongs to its first publisher, as long as that one exists and is not silent. While
// another one contradicts it, either may be right: the frame has no transform.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pose.hpp"
#include "monitor/sensors/pose_series.hpp"

namespace clearance {

class FrameHistory {
 public:
  static constexpr std::size_t kMostFrames = 1024;
  static constexpr std::size_t kKept = 256;
  // A frame that was not heard for this long is lost, and what it did meanwhile is not known, ns.
  static constexpr std::int64_t kLostNs = 1'000'000'000;

  // Transforms that are no poses, and those of too many frames, are left out. `writer` is the
  // number of the publisher; in a log, all have the same.
  void add(const std::string& child, const std::string& parent, const Pose& parent_from_child,
           std::int64_t stamp_ns, bool is_static, std::uint64_t writer = 0);
  // `writers` are those that still exist; sorted.
  void keep(std::span<const std::uint64_t> writers);
  // This machine's clock was set back: the transforms that have stamps say nothing about times that
  // come again.
  void forget();

  struct Step {
    std::string parent;
    Pose parent_from_child;
    double shift_error = 0.0, turn_error = 0.0;  // m, rad
    std::int64_t longest_ns = 0;                 // between two transforms around that time
  };
  // Returns nothing if the frame has no place at that time, which is known to `within_ns`: the
  // errors enclose its motion within.
  [[nodiscard]] std::optional<Step> step(const std::string& child, std::int64_t stamp_ns,
                                         std::int64_t within_ns = 0) const;

  // Appends the stamps of its transforms from the first time to the last one, and those of the two
  // around these times. A static frame has none.
  void append_stamps(const std::string& child, std::int64_t first_ns, std::int64_t last_ns,
                     std::vector<std::int64_t>& stamps) const;

  struct Parent {
    const std::string* name = nullptr;
    std::int64_t known_until_ns = 0;  // the stamp of its last transform; if static, the last time
  };
  // Returns nothing if the frame has no transform, or two publishers contradict each other.
  [[nodiscard]] std::optional<Parent> parent(const std::string& child, std::int64_t stamp_ns) const;

 private:
  struct Frame {
    std::string parent;
    bool is_static = false;
    PoseSeries poses{1};
    std::optional<std::uint64_t> writer;  // nothing: it has left
    std::optional<std::uint64_t> rival;   // that contradicts it
    std::int64_t rival_ns = 0;            // of its last contradiction
    bool rival_is_static = false;
  };
  [[nodiscard]] const Frame* undisputed(const std::string& child, std::int64_t stamp_ns) const;
  [[nodiscard]] static bool agrees(const Frame& frame, const Pose& pose, std::int64_t stamp_ns);
  [[nodiscard]] static std::optional<Step> place_of(const Frame& frame, std::int64_t stamp_ns,
                                                    std::int64_t within_ns);
  std::map<std::string, Frame> frames_;  // by child
};

}  // namespace clearance
