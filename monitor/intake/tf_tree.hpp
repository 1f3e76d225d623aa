// The frames that transforms connect, as /tf and /tf_static give them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/pose.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

// Not interpolated: every transform on a way is the newest that has come.
class TfTree {
 public:
  // A frame's pose in `root`.
  struct Place {
    std::string root;
    Pose root_from_frame;
    // Of the oldest transform on the way that may change; nothing: none of them does.
    std::optional<std::int64_t> stamp_ns;
  };
  struct Link {
    std::string parent;
    Pose parent_from_child;
    std::optional<std::int64_t> stamp_ns;  // nothing: it never changes
  };

  // Replaces what was known of the child. `is_static`: it came on /tf_static.
  void set(const geometry_msgs_msg_dds__TransformStamped_& transform, bool is_static);
  void set(const std::string& child, Link link) { links_[child] = std::move(link); }

  // Up to `world`, or, where the way does not lead there, to the root of the tree. Nothing: no
  // transform has this frame as child, or they go round in a circle.
  [[nodiscard]] std::optional<Place> find(const std::string& frame,
                                          const std::string& world = "") const;

  // Null: no transform has this frame as child.
  [[nodiscard]] const Link* link(const std::string& child) const;
  [[nodiscard]] const std::map<std::string, Link>& links() const noexcept { return links_; }

 private:
  std::map<std::string, Link> links_;  // by child
};

// Of a message's header, ns; 0: its publisher states none.
[[nodiscard]] std::int64_t stamp_ns(const std_msgs_msg_dds__Header_& header) noexcept;

[[nodiscard]] Pose pose_of(const geometry_msgs_msg_dds__Transform_& transform) noexcept;

// Without the slash in front that some publishers write.
[[nodiscard]] std::string frame_name(const std::string& name);

}  // namespace clearance
