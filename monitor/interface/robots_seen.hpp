// What a camera's pictures say of robots: whether they are where their joints say.
#pragma once

#include <cstdint>

namespace clearance {

// The robots of a scene that pictures can speak of: the first ones.
inline constexpr std::uint32_t kMostRobotsSeen = 64;

// One picture. Bit i is of Scene::robots[i]; neither: the picture says nothing of it.
struct RobotsSeen {
  std::uint64_t there = 0, not_there = 0;
};

// Counts pictures of one camera about one robot.
struct SeenCount {
  std::uint32_t against = 0, in_favour = 0;  // pictures in a row
  bool denied = false;

  // `frames` pictures in a row change the verdict. Others leave it as it is.
  void add(bool there, bool not_there, std::uint32_t frames) noexcept {
    if (not_there) {
      ++against;
      in_favour = 0;
    } else if (there) {
      ++in_favour;
      against = 0;
    }
    if (against >= frames) denied = true;
    if (in_favour >= frames) denied = false;
  }
};

}  // namespace clearance
