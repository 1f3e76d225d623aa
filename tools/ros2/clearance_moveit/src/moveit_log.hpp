// The log of this package, as MoveIt names its own.
#pragma once

#include <moveit/utils/logger.hpp>
#include <rclcpp/logging.hpp>

namespace clearance_moveit {

[[nodiscard]] inline rclcpp::Logger logger() {
  return moveit::getLogger("moveit.core.clearance_moveit");
}

}  // namespace clearance_moveit
