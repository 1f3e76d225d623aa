// Reads the log twice: the first pass checks every row, the second one writes. A mistake in the
// last row thus leaves no half-made recording behind.
#include "monitor/recording/csv_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "config/text/spelling.hpp"
#include "monitor/files/pose_log.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// All batches of a log have this one source.
constexpr std::string_view kSource = "csv";

// Ids for the objects of a log.
class Ids {
 public:
  explicit Ids(const Scene* scene) : scene_(scene) {
    if (scene == nullptr) return;
    for (const Object& object : scene->objects) add(object.name);
  }

  // False: the scene has no such object.
  bool know(const std::string& name) {
    if (ids_.contains(name)) return true;
    if (scene_ != nullptr) return false;
    add(name);
    return true;
  }
  [[nodiscard]] std::uint32_t id(const std::string& name) const { return ids_.at(name); }
  [[nodiscard]] bool fixed(const std::string& name) const {
    return scene_ != nullptr && scene_->objects[id(name)].fixed;
  }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

 private:
  void add(const std::string& name) {
    ids_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    names_.push_back(name);
  }

  const Scene* scene_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t> ids_;
};

// The reason why the daemon would refuse this pose, as the end of a sentence. Empty: it would
// accept the pose.
std::string fault_of(const Pose& pose) {
  const double farthest = pose.position.cwiseAbs().maxCoeff();
  if (!(farthest <= kLargestInSample)) {
    return fmt::format("has a coordinate of {:g} m; expected at most {:g} m", farthest,
                       kLargestInSample);
  }
  const double length = pose.orientation.norm();
  if (!(std::abs(length - 1.0) <= kSampleUnitTolerance)) {
    return fmt::format("has a quaternion (qw, qx, qy, qz) of length {:.6g}; expected 1 within {:g}",
                       length, kSampleUnitTolerance);
  }
  return "";
}

// Returns true when the conversion must stop in front of this row; rows count from 0.
bool stops_at(std::size_t row, const std::function<bool()>& stop) {
  constexpr std::size_t kRowsBetween = 1024;
  return stop && row % kRowsBetween == 0 && stop();
}

// The first pass: everything that can be wrong with the log.
void check(const std::filesystem::path& csv, Ids& ids, const std::function<bool()>& stop,
           CsvRecordingResult& result) {
  CsvPoseLog log(csv);
  CsvPose pose;
  while (log.next(pose)) {
    if (stops_at(result.rows, stop)) {
      result.error = fmt::format("stopped after {} rows of {} were checked: nothing was written",
                                 result.rows, csv.string());
      return;
    }
    if (!ids.know(pose.object)) {
      result.error = log.located(fmt::format("the cell has no object '{}'{}", pose.object,
                                             did_you_mean(pose.object, ids.names())));
      return;
    }
    if (const std::string fault = fault_of(pose.world_from_object); !fault.empty()) {
      result.error = log.located(fault);
      return;
    }
    if (result.rows++ == 0) result.first_ns = pose.t_ns;
    result.last_ns = pose.t_ns;
    if (std::ranges::find(result.objects, pose.object) != result.objects.end()) continue;
    result.objects.push_back(pose.object);
    if (ids.fixed(pose.object)) result.fixed_objects.push_back(pose.object);
  }
  result.error = log.error();
  if (result.error.empty() && result.rows == 0)
    result.error = fmt::format("{} has no rows", csv.string());
}

// Without a cell, the recording names the objects of the log and has no shapes.
Cell cell_of(const std::filesystem::path& csv, const std::vector<std::string>& objects) {
  Cell cell;
  cell.scene.name = csv.stem().stem().string();
  for (const std::string& name : objects) cell.scene.objects.emplace_back().name = name;
  return cell;
}

// The second pass: one batch for each time, or several when there are more poses than a batch can
// hold.
class BatchWriter {
 public:
  BatchWriter(RecordingWriter& out, std::uint64_t scene_revision)
      : out_(out), wire_(make_batch(clearance_msg_kMaxPoses)) {
    batch_.source = SourceName(kSource);
    batch_.scene_revision = scene_revision;
  }

  void add(std::uint32_t id, const CsvPose& pose) {
    const bool same_time = !batch_.samples.empty() && batch_.samples.back().stamp_ns == pose.t_ns;
    if (!same_time || batch_.samples.size() == clearance_msg_kMaxPoses) flush();
    PoseSample& sample = batch_.samples.emplace_back();
    sample.object = id;
    sample.stamp_ns = pose.t_ns;
    sample.world_from_object = pose.world_from_object;
  }

  void flush() {
    if (batch_.samples.empty()) return;
    ++batch_.sequence_number;
    to_wire(batch_, *wire_);
    const std::int64_t t_ns = batch_.samples.front().stamp_ns;
    out_.write(TopicKind::kPoses, t_ns, t_ns, *wire_);
    batch_.samples.clear();
  }

  [[nodiscard]] std::uint64_t written() const noexcept { return batch_.sequence_number; }

 private:
  RecordingWriter& out_;
  PoseBatch batch_;
  Sample<clearance_msg_PoseBatch> wire_;
};

}  // namespace

// Rows of fixed objects are counted but not written: the cell gives their poses.
CsvRecordingResult record_csv(const std::filesystem::path& csv, const std::filesystem::path& out,
                              const Cell* cell, const RecordingOptions& options,
                              const std::function<bool()>& stop) {
  CsvRecordingResult result;
  Ids ids(cell == nullptr ? nullptr : &cell->scene);
  check(csv, ids, stop, result);
  if (!result.error.empty()) return result;

  const Cell made = cell == nullptr ? cell_of(csv, ids.names()) : Cell{};
  const Cell& named = cell == nullptr ? made : *cell;
  RecordingWriter writer(out, named.topics, options);
  result.begun = writer.ok();
  static_cast<void>(writer.attach(named));  // a replay reports that they are missing
  writer.catalogue(*make_catalogue(named), result.first_ns);
  BatchWriter batches(writer, named.scene.revision);
  CsvPoseLog log(csv);
  CsvPose pose;
  std::size_t rows = 0;
  for (; log.next(pose) && !stops_at(rows, stop); ++rows) {
    if (!ids.fixed(pose.object)) batches.add(ids.id(pose.object), pose);
  }
  batches.flush();
  result.samples = static_cast<std::size_t>(batches.written());
  if (!writer.close()) {
    result.error = writer.error();
  } else if (rows < result.rows) {
    result.error =
        fmt::format("stopped after {} of {} rows of {}", rows, result.rows, csv.string());
  }
  return result;
}

}  // namespace clearance
