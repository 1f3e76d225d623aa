// A part keeps this of its queries of a cloud.
#pragma once

#include <array>
#include <cstdint>

#include "core/distance_result.hpp"
#include "core/pose.hpp"
#include "monitor/clouds/plane_bounds.hpp"

namespace clearance {

// The groups of eight nodes or elements that the last query has looked at, from the root down.
// Every lane of a group has a plane and hence a bound, or is a group in turn: so each element of
// the cloud is below one lane, in every cloud with as many levels.
//
// Planes are facts about the part. They stay true while it moves, and in the next frame. The least
// bound of a group is carried: the next query subtracts the motion since then, and computes the
// bound again only if too little is left.
class CloudCut {
 public:
  static constexpr std::size_t kSlots = 512;
  static constexpr std::uint16_t kNoSlot = 0xFFFF;

  // The children of node `index` of `level`, or the elements of block `index` for level 0.
  struct Group {
    std::uint32_t index = 0;
    std::uint16_t parent = kNoSlot;
    std::uint8_t level = 0, lane = 0;  // of the parent
    std::uint8_t expanded = 0;         // a bit a lane: it has a slot of its own
    bool stored = false;
  };

  // Members without a value are those of slots in use.
  CloudCut() noexcept : count(0) {}

  std::uint32_t count;           // slots that are or were in use
  std::uint32_t in_use = 0;      // and those that are
  std::uint32_t checked = 0;     // the slot that was last looked at for removal
  std::uint16_t free = kNoSlot;  // the first slot to use again; Group::parent is the next one
  std::size_t levels = 0;        // of the tree that this is a cut of
  std::uint64_t revision = 0;    // of the cloud of the carried bounds; 0: none
  // The motion of the cloud in the part's frame since the cut was made: a point x has moved by at
  // most travelled + turned |x - pivot|, m.
  double travelled = 0.0, turned = 0.0;
  Vec3 pivot = Vec3::Zero();  // in the cloud's frame
  RelativePose last;          // of the last query
  double last_error = 0.0;    // m: the places of the cloud's points by `last` are off by this

  // By slot. The least bound of all lanes that are not expanded is at least
  // carried - travelled - turned * farthest; infinite for a slot that is free.
  alignas(64) std::array<double, kSlots> carried;
  alignas(64) std::array<double, kSlots> farthest;  // |x - pivot|, m; negative: not known
  std::array<Group, kSlots> groups;
  alignas(64) std::array<PlaneLanes, kSlots> planes;
};

// The state of a part between queries, also from one frame to the next, and for any cloud. Block,
// lane, features and normal are hints. The cut has facts about `part`: a query of another body
// drops it. Some 160 kB, mostly untouched.
struct CloudTracking {
  CloudTracking() noexcept = default;

  std::uint32_t block = 0, lane = 0;  // the place of the last nearest element
  TrackingState features;             // of the part and a point of it
  TrackingState body_features;        // of the part and a slab
  Vec3 normal = Vec3::Zero();         // of the last answer
  const ConvexBody* part = nullptr;
  CloudCut cut;

  // The next query is a cold one.
  void forget() noexcept {
    block = lane = 0;
    features = body_features = {};
    normal = Vec3::Zero();
    part = nullptr;
  }
};

}  // namespace clearance
