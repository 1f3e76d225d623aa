// The first batch is read before the file is made, so a log without batches leaves no recording
// behind.
#include "monitor/recording/log_recording.hpp"

#include <fmt/format.h>

#include <memory>

#include "monitor/recording/writer.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

// A batch always fits into a message, because the objects and joints of a cell are limited in
// number.
void write(const LoggedBatch& logged, const Scene& scene, RecordingWriter& writer,
           clearance_msg_PoseBatch& poses) {
  const PoseBatch& batch = logged.batch;
  const std::int64_t stamp_ns =
      batch.joints.empty() ? batch.samples.front().stamp_ns : batch.joints.front().stamp_ns;
  if (batch.joints.empty()) {
    to_wire(batch, poses);
    writer.write(TopicKind::kPoses, logged.log_ns, stamp_ns, poses);
  } else {
    writer.write(TopicKind::kJointStates, logged.log_ns, stamp_ns,
                 *make_joint_states(batch, scene));
  }
}

}  // namespace

LogRecordingResult record_log(const std::filesystem::path& log, const std::filesystem::path& out,
                              const Cell& cell, const InputLogOptions& log_options,
                              const RecordingOptions& options, const std::function<bool()>& stop) {
  LogRecordingResult result;
  const std::unique_ptr<InputLog> input = open_input_log(log, cell, log_options);
  LoggedBatch batch;
  bool more = input->next(batch);
  if (!more) {
    result.error = input->error();
    result.notes = input->notes();
    return result;
  }
  RecordingWriter writer(out, cell.topics, options);
  result.begun = writer.ok();
  result.first_ns = batch.log_ns;
  static_cast<void>(writer.attach(cell));  // a replay reports that they are missing
  writer.catalogue(*make_catalogue(cell), result.first_ns);
  Sample<clearance_msg_PoseBatch> poses = make_batch(clearance_msg_kMaxPoses);
  for (; more && writer.ok(); more = input->next(batch)) {
    if (stop && stop()) {
      result.error = fmt::format("stopped after {} batches of {}", result.batches, log.string());
      break;
    }
    if (batch.batch.empty()) continue;
    writer.roll(batch.log_ns);
    write(batch, cell.scene, writer, *poses);
    ++result.batches;
    result.last_ns = batch.log_ns;
  }
  result.damage = input->error();
  result.notes = input->notes();
  if (!writer.close() && result.error.empty()) result.error = writer.error();
  return result;
}

}  // namespace clearance
