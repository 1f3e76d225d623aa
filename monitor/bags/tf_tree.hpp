// The frames that transforms connect, as /tf and /tf_static give them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/pose.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

class TfTree {
 public:
  // A frame's pose in the root of its tree.
  struct Place {
    std::string root;
    Pose root_from_frame;
    // Of the oldest transform on the way that may change; nothing: none of them does.
    std::optional<std::int64_t> stamp_ns;
  };

  // Replaces what was known of the child. `is_static`: it came on /tf_static.
  void set(const geometry_msgs_msg_dds__TransformStamped_& transform, bool is_static);

  // Nothing: no transform has this frame as child, or they go round in a circle.
  [[nodiscard]] std::optional<Place> find(const std::string& frame) const;

 private:
  struct Link {
    std::string parent;
    Pose parent_from_child;
    std::optional<std::int64_t> stamp_ns;
  };
  std::map<std::string, Link> links_;  // by child
};

// Of a message's header, ns; 0: its publisher states none.
[[nodiscard]] std::int64_t stamp_ns(const std_msgs_msg_dds__Header_& header) noexcept;

// Without the slash in front that some publishers write.
[[nodiscard]] std::string frame_name(const std::string& name);

}  // namespace clearance
