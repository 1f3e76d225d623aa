// The variables of a scene's robots by their names, as joint states have them.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "config/scene/scene.hpp"

namespace clearance {

class JointNames {
 public:
  static constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kUnused = kUnknown - 1;  // fixed, mimics another, or is not read

  // On our own topic: the names of all robots, with their prefixes.
  explicit JointNames(const Scene& scene);
  // On a topic of ROS 2 such as "/left/joint_states": the names of the robots that name this topic,
  // with or without their prefixes. If no robot names it: the names of the robots that name no
  // topic, with their prefixes.
  JointNames(const Scene& scene, std::string_view ros_topic);

  // Index into Scene::variables, or one of the above.
  [[nodiscard]] std::uint32_t find(std::string_view name) const;

 private:
  enum class Prefix : std::uint8_t { kKept, kLeftOut };
  void add(const Scene& scene, std::uint32_t robot, Prefix prefix);

  std::map<std::string, std::uint32_t, std::less<>> variables_;
};

}  // namespace clearance
