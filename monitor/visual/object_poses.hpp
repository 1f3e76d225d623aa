// The poses of a cell's objects as a client can know them: those that the latest report used. They
// come from the same batches that the daemon takes (intake/).
//
// For each source, the report names the last batch that its tick used. If the tick used no batch,
// the report has the stamp of the newest pose in use. Later batches wait for the report that uses
// them, so that bodies, witness points and distances belong together. Batches go through the
// daemon's own ingest stage (bodies/ingest.hpp) and kinematics. Samples that the daemon refuses
// are therefore not shown either.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "monitor/ask/path_frames.hpp"
#include "monitor/bodies/ingest.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"

namespace clearance {

class ObjectPoses {
 public:
  // Fixed objects have their poses from the start. `scene` must outlive this.
  explicit ObjectPoses(const Scene& scene);

  // The origin of a batch's sequence number. A sender's number is the one that reports name. ROS 2
  // topics have no numbers: only the stamps show which report used a batch.
  enum class Numbers : std::uint8_t { kOfSender, kUnnumbered };
  // Takes a batch. A batch of another scene is ignored.
  void take(PoseBatch batch, Numbers numbers);

  // Moves the objects to their poses in this report.
  void use(const clearance_msg_Distances& report);

  // The position of a joint variable at the latest report, rad or m; NaN before the first one.
  [[nodiscard]] double position(std::size_t variable) const {
    const TrackedVariable& state = inputs_->robots.variables()[variable];
    return state.input.has_value ? state.position : std::numeric_limits<double>::quiet_NaN();
  }
  // The links along a motion that begins at the latest report (path_frames).
  [[nodiscard]] std::vector<PathFrame> along(const Question& question, std::size_t count,
                                             std::span<const double> more = {}) const;
  // The links of robots that state how they stop, and what stands on them, where they come to
  // stand if all of them are told to stop at the latest report. A robot whose joints are not all
  // on time with a velocity is left out.
  [[nodiscard]] std::vector<PathFrame::Placed> at_standstill() const;
  // World from object; null before the first pose.
  [[nodiscard]] const Pose* pose(std::size_t object) const {
    const TrackedObject& state = inputs_->objects[object];
    return state.input.has_value ? &state.pose : nullptr;
  }
  // The pose's age at the latest report, ns: 0 for a fixed object, -1 without a pose.
  [[nodiscard]] std::int64_t age_ns(std::size_t object) const {
    return inputs_->objects[object].input.age_ns(inputs_->time.now_ns);
  }
  // True if it had a pose at the latest report that was within its age limit and not contradicted.
  [[nodiscard]] bool is_on_time(std::size_t object) const;
  void forget();  // forgets all but the fixed objects

 private:
  struct Batch {
    std::uint64_t sequence_number;
    std::int64_t stamp_ns;  // the newest stamp in it
    PoseBatch content;
  };
  // The waiting batches of one source, in order.
  struct Waiting {
    std::deque<Batch> batches;
    std::size_t samples = 0;
  };

  void wait(PoseBatch batch, std::uint64_t sequence_number);
  // Moves batches into `due_` if their sequence number or their stamp shows that they have been
  // used.
  void take_up_to(std::uint64_t sequence_number, std::int64_t stamp_ns, Waiting& waiting);

  const Scene& scene_;
  SourceNumbers numbers_;
  const Inputs nothing_known_;
  std::optional<Inputs> inputs_;                         // replaced when forgetting
  std::map<std::string, Waiting, std::less<>> waiting_;  // by source
  PoseBatch due_;  // used batches of all sources, until they are ingested
};

}  // namespace clearance
