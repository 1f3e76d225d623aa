// Inputs of the tick that another program recorded: a ROS 2 bag, or joint positions as CSV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "config/scene/scene_map.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/scene_ids.hpp"

namespace clearance {

namespace moveit {
struct RawScene;
}
struct RawSensorMessage;

// One message. With an empty batch alone, it moves nothing, and tells how late it is.
struct LoggedBatch {
  PoseBatch batch;
  // When it was recorded. With `use_sim_time`, no earlier than the stamps that lead the time.
  std::int64_t log_ns = 0;
  // A message of MoveIt that keeps the scene; the batch is then empty. Null: it is a batch.
  std::shared_ptr<const moveit::RawScene> scene = {};
  // Likewise, a message of a sensor, or transforms that may place one.
  std::shared_ptr<const RawSensorMessage> sensor = {};
};

// The scene `now` follows `before`, as `map` says: a batch that was made for that one gets the ids
// of the changed scene.
inline void pass_on(const SceneMap& map, const Scene& before, const Scene& now, PoseBatch& batch) {
  if (batch.scene_revision != before.revision) return;
  batch.scene_revision = now.revision;
  keep_mapped(map.objects_now, &PoseSample::object, 0, batch.samples);
  keep_mapped(map.variables_now, &JointSample::variable, 0, batch.joints);
}

struct InputLogOptions {
  // The topics whose joint states are used. If empty, these are all topics named joint_states, in
  // any namespace.
  std::vector<std::string> joint_topics = {};
  // Constant positions of joints that are not in the log, by name.
  std::map<std::string, double> joints = {};
  // Gives out the messages of MoveIt on the topics that the cell names. Otherwise they are left
  // out.
  bool with_scenes = false;
  // Gives out the messages of the cell's sensors. Otherwise they are left out.
  bool with_sensors = false;
};

// One thread at a time may use a log.
class InputLog {
 public:
  virtual ~InputLog() = default;
  // Reads the next batch; log times never decrease. Returns false at the end, or where the log is
  // damaged: error() is then not empty.
  [[nodiscard]] virtual bool next(LoggedBatch& batch) = 0;
  // A message of the log has changed the cell: what follows is read by the names of this one, which
  // must outlive the log. Batches state the cell whose ids they have.
  virtual void change(const Cell&) {}
  // A sentence with file, place and reason; empty for a sound log.
  [[nodiscard]] virtual const std::string& error() const noexcept = 0;
  // True: the batches before the error are sound. False: the log cannot be read at all.
  [[nodiscard]] virtual bool readable() const noexcept = 0;
  // The share of the log that has been read, 0 to 1.
  [[nodiscard]] virtual double progress() const noexcept = 0;
  // Notes for a person about what was read so far: what was used, and what was left out and why.
  // Each note is one sentence.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
  // True if it has topics, so that a sensor may have been recorded.
  [[nodiscard]] virtual bool has_topics() const noexcept { return false; }
  // The topics that were read so far and could be this sensor's, each with its type and its number
  // of messages, whatever the cell says of them.
  [[nodiscard]] virtual std::vector<std::string> topics_of(SensorKind) const { return {}; }
};

// True if the first bytes are those of such a log. It is a bag without our own topics, or a CSV
// table with other columns than a pose log. False for a file that cannot be read.
[[nodiscard]] bool is_input_log(const std::filesystem::path& path);

// The cell must outlive the log. Never null. A cell with `tracked_bodies` needs a bag and
// `with_scenes`: otherwise the log has an error and no batch.
[[nodiscard]] std::unique_ptr<InputLog> open_input_log(const std::filesystem::path& path,
                                                       const Cell& cell,
                                                       const InputLogOptions& options = {});

}  // namespace clearance
