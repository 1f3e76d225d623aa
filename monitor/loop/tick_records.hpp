// The ticks that the loop has run and its successor has not, with their samples. The memory is kept
// from change to change: making it takes longer than most changes.
#pragma once

#include <cstddef>
#include <vector>

#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/loop/spsc_ring.hpp"

namespace clearance {

struct TickRecords {
  struct Tick {
    TickTime time;
    std::size_t poses = 0, joints = 0;  // the number of its samples
    bool certified = false;             // the minimum of its report
  };
  // The number of ticks, and of samples in them, that catching up may lag behind the loop.
  struct Room {
    std::size_t ticks = 1024, poses = 1 << 14, joints = 1 << 14;
  };

  explicit TickRecords(const Room& room)
      : ticks(room.ticks), poses(room.poses), joints(room.joints) {
    taken_poses.reserve(poses.capacity());
    taken_joints.reserve(joints.capacity());
  }
  TickRecords() : TickRecords(Room()) {}

  // While no thread uses them.
  void clear() noexcept {
    ticks.clear();
    poses.clear();
    joints.clear();
  }

  SpscRing<Tick> ticks;
  SpscRing<PoseSample> poses;
  SpscRing<JointSample> joints;
  std::vector<PoseSample> taken_poses;  // of one tick, with the indices of the changed scene
  std::vector<JointSample> taken_joints;
};

}  // namespace clearance
