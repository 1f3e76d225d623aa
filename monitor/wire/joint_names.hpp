// The variables of a scene's robots by their names, as joint states have them.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "config/scene.hpp"

namespace clearance {

class JointNames {
 public:
  static constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kUnused = kUnknown - 1;  // of a fixed joint, or one that mimics

  explicit JointNames(const Scene& scene);

  // Index into Scene::variables, or one of the above.
  [[nodiscard]] std::uint32_t find(std::string_view name) const;

 private:
  std::map<std::string, std::uint32_t, std::less<>> variables_;
};

}  // namespace clearance
