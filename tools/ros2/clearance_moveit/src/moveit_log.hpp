// The logger moveit.core.clearance_moveit.
#pragma once

#include <moveit/utils/logger.hpp>
#include <rclcpp/logging.hpp>

namespace clearance_moveit {

[[nodiscard]] inline rclcpp::Logger logger() {
  return moveit::getLogger("moveit.core.clearance_moveit");
}

}  // namespace clearance_moveit
