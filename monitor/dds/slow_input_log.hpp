// Tells the log, once each, whose poses or joint states come too seldom for their age limits.
#pragma once

#include "config/scene/scene.hpp"
#include "monitor/dds/slow_inputs.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

class SlowInputLog {
 public:
  // The scene must outlive this.
  explicit SlowInputLog(const Scene& scene);
  // To be called with every batch.
  void note(const PoseBatch& batch);

 private:
  void note_poses(const PoseBatch& batch);
  void note_joints(const PoseBatch& batch);

  const Scene& scene_;
  SlowInputs poses_, joints_;
};

}  // namespace clearance
