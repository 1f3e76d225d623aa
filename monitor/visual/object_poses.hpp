// Where the objects of a cell are, as a client can know it: the poses that the latest report used,
// from the batches that come in (intake/).
//
// The report names the last batch of each source that its tick took in, and where it took in none,
// the stamp of the newest pose in use. Later batches wait for the report that uses them, so that
// bodies, witness points and distances belong together. What is used goes through the stage of the
// tick that takes poses and joints in (objects/ingest.hpp) and through its kinematics: what the
// daemon refuses is not shown either.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/objects/ingest.hpp"

namespace clearance {

class ObjectPoses {
 public:
  // Fixed objects have their poses from the start; `scene` must outlive this.
  explicit ObjectPoses(const Scene& scene);

  // Who has numbered a batch: its sender, as reports name it; or nobody, as of ROS 2's topics: then
  // only its stamps say which report has used it.
  enum class Numbers : std::uint8_t { kOfSender, kUnnumbered };
  // A batch of another scene is passed over.
  void take(PoseBatch batch, Numbers numbers);

  // Moves the objects to where they were for this report.
  void use(const clearance_msg_Distances& report);

  // World from object; null until the first pose.
  [[nodiscard]] const Pose* pose(std::size_t object) const {
    const TrackedObject& state = inputs_->objects[object];
    return state.input.has_value ? &state.pose : nullptr;
  }
  void forget();  // all but the fixed ones

 private:
  struct Batch {
    std::uint64_t sequence_number;
    std::int64_t stamp_ns;  // the newest in it
    PoseBatch content;
  };
  // Of one source, in order.
  struct Waiting {
    std::deque<Batch> batches;
    std::size_t samples = 0;
  };

  void wait(PoseBatch batch, std::uint64_t sequence_number);
  // Moves batches into `due_` as long as one of the two says that they have been used.
  void take_up_to(std::uint64_t sequence_number, std::int64_t stamp_ns, Waiting& waiting);

  const Scene& scene_;
  SourceNumbers numbers_;
  const Inputs nothing_known_;
  std::optional<Inputs> inputs_;                         // made anew to forget
  std::map<std::string, Waiting, std::less<>> waiting_;  // by source
  PoseBatch due_;                                        // of any sources, until they are taken in
};

}  // namespace clearance
