// Where the objects of a cell are, as a client can know it: the poses that the latest report used,
// taken from the batches of the poses topic.
//
// The report names the last batch of each source that its tick took in, and where it took in none,
// the stamp of the newest pose in use. Poses of later batches wait for the report that uses them,
// so that bodies, witness points and distances belong together. Not judged here: a pose that the
// daemon refuses as implausible is shown all the same.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clearance.h"
#include "config/scene.hpp"

namespace clearance {

class ObjectPoses {
 public:
  // Fixed objects have their poses from the start; `scene` must outlive this.
  explicit ObjectPoses(const Scene& scene);

  // Batches of another scene and poses that the scene has no place for are passed over.
  void take(const clearance_msg_PoseBatch& batch);

  // Moves the objects to where they were for this report. True: some object has moved.
  bool use(const clearance_msg_Distances& report);

  // World from object; none until the first pose.
  [[nodiscard]] const std::optional<Pose>& pose(std::size_t object) const {
    return objects_[object].pose;
  }
  void forget();  // all but the fixed ones

 private:
  struct Moved {
    std::uint32_t object;
    std::int64_t stamp_ns;
    Pose pose;
  };
  struct Batch {
    std::uint64_t sequence_number;
    std::int64_t stamp_ns;  // the newest of its poses
    std::vector<Moved> poses;
  };
  struct Known {
    std::optional<Pose> pose;
    std::int64_t stamp_ns = 0;
    std::string source;
  };

  void apply(const std::string& source, const Batch& batch);
  void apply_up_to(std::uint64_t sequence_number, std::int64_t stamp_ns, const std::string& source);

  const Scene& scene_;
  std::vector<Known> objects_;
  std::map<std::string, std::deque<Batch>> waiting_;  // by source, in order
  bool moved_ = false;
};

}  // namespace clearance
