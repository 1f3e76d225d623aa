#include "monitor/intake/octomap_tree.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace clearance {
namespace {

constexpr int kDepth = 16;  // levels below the root, of all octomaps
constexpr std::size_t kColour = 3;

// The place of a node: its low corner as the number of smallest cubes from that of the tree, and
// its depth below the root.
struct Place {
  std::array<std::uint32_t, 3> low{};
  int depth = 0;

  // Bit 0 of a child's number is x, bit 1 is y, bit 2 is z.
  [[nodiscard]] Place child(unsigned number) const noexcept {
    Place of = *this;
    ++of.depth;
    for (unsigned k = 0; k < 3; ++k) of.low[k] += (number >> k & 1U) << (kDepth - of.depth);
    return of;
  }
};

class Reader {
 public:
  Reader(const OctomapView& map, std::size_t most, std::vector<MeasuredPoint>& cubes,
         double& excess)
      : map_(map),
        most_(most),
        cubes_(cubes),
        node_bytes_(map.id == "ColorOcTree" ? 8 : 5),
        excess_(excess) {}

  // The root of the full form has a value of its own; that of the binary form has none.
  [[nodiscard]] OctomapFault run() {
    if (map_.bytes.empty()) return OctomapFault::kNoFault;
    const OctomapFault fault = map_.is_binary ? read_binary({}) : read_full({});
    if (fault != OctomapFault::kNoFault) return fault;
    // Leaves of one depth keep one size.
    for (MeasuredPoint& cube : cubes_) {
      const double half = half_at(static_cast<int>(cube.radius));
      cube.radius = std::nextafter(static_cast<float>(half + rounding_),
                                   std::numeric_limits<float>::infinity());
      // Along each axis, a face is off by the growth of the half and the rounding of the centre.
      excess_ = std::max(excess_, kCubeRadius * (double{cube.radius} - half + rounding_));
    }
    return at_ == map_.bytes.size() ? OctomapFault::kNoFault : OctomapFault::kCut;
  }

 private:
  [[nodiscard]] OctomapFault read_binary(const Place& node) {
    if (node.depth == kDepth) return OctomapFault::kTooDeep;
    if (map_.bytes.size() - at_ < 2) return OctomapFault::kCut;
    const auto children =
        static_cast<unsigned>(std::to_integer<unsigned>(map_.bytes[at_]) |
                              std::to_integer<unsigned>(map_.bytes[at_ + 1]) << 8);
    at_ += 2;
    // Leaves come first and have no bytes; then the children that have children, in their order.
    for (unsigned i = 0; i < 8; ++i) {
      if ((children >> 2 * i & 3U) != kOccupied) continue;
      if (const OctomapFault fault = add(node.child(i)); fault != OctomapFault::kNoFault)
        return fault;
    }
    for (unsigned i = 0; i < 8; ++i) {
      if ((children >> 2 * i & 3U) != kInner) continue;
      if (const OctomapFault fault = read_binary(node.child(i)); fault != OctomapFault::kNoFault)
        return fault;
    }
    return OctomapFault::kNoFault;
  }

  [[nodiscard]] OctomapFault read_full(const Place& node) {
    if (map_.bytes.size() - at_ < node_bytes_) return OctomapFault::kCut;
    float log_odds = 0.0F;
    std::memcpy(&log_odds, map_.bytes.data() + at_, sizeof log_odds);
    const auto children = std::to_integer<unsigned>(map_.bytes[at_ + node_bytes_ - 1]);
    at_ += node_bytes_;
    // A value that is no number is not free.
    if (children == 0) return log_odds < 0.0F ? OctomapFault::kNoFault : add(node);
    if (node.depth == kDepth) return OctomapFault::kTooDeep;
    for (unsigned i = 0; i < 8; ++i) {
      if ((children >> i & 1U) == 0) continue;
      if (const OctomapFault fault = read_full(node.child(i)); fault != OctomapFault::kNoFault)
        return fault;
    }
    return OctomapFault::kNoFault;
  }

  // Half of the side of a leaf at this depth, m.
  [[nodiscard]] double half_at(int depth) const noexcept {
    return 0.5 * map_.resolution * static_cast<double>(1U << (kDepth - depth));
  }

  // The depth stands for the size until all leaves are known.
  [[nodiscard]] OctomapFault add(const Place& leaf) {
    if (cubes_.size() == most_) return OctomapFault::kTooMany;
    std::array<float, 3> centre{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double exact =
          (static_cast<double>(leaf.low[k]) - 0x1p15) * map_.resolution + half_at(leaf.depth);
      centre[k] = static_cast<float>(exact);
      rounding_ =
          std::max(rounding_, std::abs(exact - double{centre[k]}) + 0x1p-50 * std::abs(exact));
    }
    cubes_.push_back({centre[0], centre[1], centre[2], static_cast<float>(leaf.depth)});
    return OctomapFault::kNoFault;
  }

  // The two bits of a child in the binary form; free is 1.
  static constexpr unsigned kOccupied = 2, kInner = 3;

  const OctomapView& map_;
  std::size_t most_;
  std::vector<MeasuredPoint>& cubes_;
  std::size_t node_bytes_, at_ = 0;
  double rounding_ = 0.0;  // of any coordinate, m
  double& excess_;
};

static_assert(sizeof(float) + kColour + 1 == 8);

}  // namespace

OctomapFault occupied_cubes(const OctomapView& map, std::size_t most,
                            std::vector<MeasuredPoint>& cubes, double& excess) {
  cubes.clear();
  excess = 0.0;
  const bool is_known = map.id == "OcTree" || map.id == "ColorOcTree";
  if (!is_known) return OctomapFault::kKind;
  if (!(map.resolution > 0.0 && map.resolution <= kLargestResolution))
    return OctomapFault::kResolution;
  return Reader(map, most, cubes, excess).run();
}

}  // namespace clearance
