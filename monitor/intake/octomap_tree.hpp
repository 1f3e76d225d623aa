// The tree of an octomap_msgs/Octomap as the cubes of its occupied leaves.
//
// Both forms list the nodes depth first, children in ascending order. The binary form has two bits
// a child: free, occupied, with children, or nothing. The full form has the log-odds of each node
// as float32, and a byte that says which children follow. A leaf is occupied if its log-odds are at
// least 0, a probability of one half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "monitor/clouds/point_cloud.hpp"

namespace clearance {

// A view of a message's memory.
struct OctomapView {
  bool is_binary = false;
  std::string_view id;      // "OcTree", or of the full form also "ColorOcTree"
  double resolution = 0.0;  // m: the side of the smallest cubes
  std::span<const std::byte> bytes;
};

enum class OctomapFault : std::uint8_t {
  kNoFault,
  kKind,        // an id that is not known
  kResolution,  // not positive, or above kLargestResolution
  kCut,         // the bytes end within the tree, or go on after it
  kTooDeep,     // more than 16 levels below the root
  kTooMany,     // more occupied leaves than `most`
};
inline constexpr double kLargestResolution = 10.0;  // m

// Replaces `cubes` by the occupied leaves: centre and half of the side, in the frame of the map, m.
// Each contains the exact cube, and no point of it is farther from that than `excess`, m: the
// largest rounding of a centre to float32. An empty tree has none. After a fault, the content of
// `cubes` means nothing. At most `most` are kept in memory.
[[nodiscard]] OctomapFault occupied_cubes(const OctomapView& map, std::size_t most,
                                          std::vector<MeasuredPoint>& cubes, double& excess);

}  // namespace clearance
