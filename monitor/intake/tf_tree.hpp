// The tree of frames that the transforms of /tf and /tf_static connect.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/pose.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

// Transforms are not interpolated: each transform of a path is the newest one.
class TfTree {
 public:
  // A frame's pose in `root`.
  struct Place {
    std::string root;
    Pose root_from_frame;
    // The stamp of the oldest transform on the path that may change; nothing if all are static.
    std::optional<std::int64_t> stamp_ns;
    // The velocity of the frame in `root`; nothing: not known. Each transform contributes its own
    // velocity: the transforms of a path have different stamps, so differences of poses give none.
    std::optional<Twist> twist = Twist{};
    std::int64_t interval_ns = 0;  // the longest time over which a part of `twist` is the mean
    bool is_of_one_time = true;    // false: where a newer transform was at `stamp_ns` is not known
  };
  struct Link {
    std::string parent;
    Pose parent_from_child;
    std::optional<std::int64_t> stamp_ns;  // nothing: it is static
    // The velocity of the child in its parent; nothing: not known.
    std::optional<Twist> twist = std::nullopt;
    std::int64_t interval_ns = 0;  // the time over which `twist` is the mean
  };

  // Replaces the transform of the child. `is_static` means that it came on /tf_static.
  void set(const geometry_msgs_msg_dds__TransformStamped_& transform, bool is_static);
  void set(const std::string& child, Link link) { links_[child] = std::move(link); }

  // A transform that is used in the place of the tree's own.
  struct Instead {
    const std::string& child;
    const Link& link;
  };

  // Returns the pose of a child in its parent at a time before the stamp of its link; nothing: not
  // known.
  using Earlier =
      std::function<std::optional<Pose>(const std::string& child, const Link&, std::int64_t)>;

  // Returns the pose of a frame in `world`, or in the root of its tree if the path does not contain
  // `world`. Returns nothing if no transform has this frame as child, or if the transforms form a
  // cycle. With `earlier`, all transforms of the path are those at its oldest stamp.
  [[nodiscard]] std::optional<Place> find(const std::string& frame, const std::string& world = "",
                                          const Instead* instead = nullptr,
                                          const Earlier& earlier = {}) const;

  // Returns null if no transform has this frame as child.
  [[nodiscard]] const Link* link(const std::string& child) const;
  [[nodiscard]] const std::map<std::string, Link>& links() const noexcept { return links_; }

 private:
  std::map<std::string, Link> links_;  // by child frame
};

// The stamp of a message's header, ns; 0 if its publisher states none.
[[nodiscard]] std::int64_t stamp_ns(const std_msgs_msg_dds__Header_& header) noexcept;

[[nodiscard]] Pose pose_of(const geometry_msgs_msg_dds__Transform_& transform) noexcept;

// Removes the leading slash that some publishers write.
[[nodiscard]] std::string frame_name(const std::string& name);

}  // namespace clearance
