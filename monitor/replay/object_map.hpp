// The objects of a recording, found again by name in the cell that it is replayed with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

class ObjectMap {
 public:
  // `recorded`: the recording's catalogue, or null when it has none. A catalogue of the same scene
  // revision, and none, leave every id as it is.
  ObjectMap(const Scene& scene, const clearance_msg_Catalogue* recorded);

  // Gives the batch the ids of the scene; poses of objects that it lacks, or has as fixed ones, are
  // left out. False: the batch was made for neither the recorded catalogue nor the scene; it must
  // not be used.
  [[nodiscard]] bool translate(PoseBatch& batch) const;

  // Sentences about objects that do not match.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }
  // Some object of the recording is a moving one of the cell, as far as can be told.
  [[nodiscard]] bool any() const noexcept { return any_; }
  // The recording was made with this very cell.
  [[nodiscard]] bool same_scene() const noexcept { return same_scene_; }

 private:
  std::uint64_t revision_;  // of batches that are taken
  bool same_scene_ = true;
  bool identity_ = true;
  bool any_ = true;
  std::vector<std::uint32_t> id_;  // by recorded id
  std::vector<std::string> notes_;
};

}  // namespace clearance
