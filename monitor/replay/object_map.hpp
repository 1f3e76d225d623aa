// The objects of a recording, found again by name in the cell that it is replayed with.
#pragma once

#include <cstdint>
#include <map>
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

  // A further catalogue of the recording, which followed those before it.
  void add(const clearance_msg_Catalogue& recorded);

  // If the recording was made with another cell: gives the batch the ids and the revision of the
  // scene; poses of objects that it lacks, or has as fixed ones, are left out. False: the batch was
  // made for no recorded catalogue; it must not be used. If it was made with this cell, the batch
  // stays as it is.
  [[nodiscard]] bool translate(PoseBatch& batch) const;

  // Sentences about objects that do not match.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }
  // Some object of the recording is a moving one of the cell, as far as can be told.
  [[nodiscard]] bool any() const noexcept { return any_; }
  // The recording was made with this very cell.
  [[nodiscard]] bool same_scene() const noexcept { return same_scene_; }

 private:
  // Returns the scene's ids by recorded id; `notes` get a sentence for each that does not match.
  std::vector<std::uint32_t> ids_of(const clearance_msg_Catalogue& recorded,
                                    std::vector<std::string>& notes);

  const Scene& scene_;
  bool same_scene_ = true;
  bool any_ = true;
  std::map<std::uint64_t, std::vector<std::uint32_t>> ids_;  // by recorded revision
  std::vector<std::string> notes_;
};

}  // namespace clearance
