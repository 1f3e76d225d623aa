// The ticks that the loop has run and its successor has not, with their samples. The memory is kept
// from change to change: making it takes longer than most changes.
#pragma once

#include <cstddef>
#include <vector>

#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/tick/spsc_ring.hpp"

namespace clearance {

struct TickRecords {
  struct Tick {
    TickTime time;
    std::size_t poses = 0, joints = 0;  // the number of its samples
    bool certified = false;             // the minimum of its report
  };
  // The number of ticks, and of samples in them, that catching up may lag behind the loop. Without
  // room for a tick, the tick thread runs each one itself.
  struct Room {
    std::size_t ticks = 1024, poses = 1 << 14, joints = 1 << 14;
  };
  static constexpr Room kNoRoom{0, 0, 0};

  explicit TickRecords(const Room& room)
      : has_room(room.ticks > 0), ticks(room.ticks), poses(room.poses), joints(room.joints) {
    own_poses.reserve(poses.capacity());
    own_joints.reserve(joints.capacity());
  }
  TickRecords() : TickRecords(Room()) {}

  // While no thread uses them.
  void clear() noexcept {
    ticks.clear();
    poses.clear();
    joints.clear();
  }

  const bool has_room;
  SpscRing<Tick> ticks;
  SpscRing<PoseSample> poses;
  SpscRing<JointSample> joints;
  std::vector<PoseSample> own_poses;  // of one tick, with the indices of the changed scene
  std::vector<JointSample> own_joints;
};

}  // namespace clearance
