// Makes recordings of logs: pose logs as CSV, ROS 2 bags and joint logs.
#include <cstdio>

#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/recording/csv_recording.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/recording/log_recording.hpp"
#include "tools/record/arguments.hpp"

namespace clearance {

int record_from_csv(const RecordArguments& arguments, const Cell* cell, StopSignal& stop) {
  const CsvRecordingResult result =
      record_csv(arguments.from_csv, arguments.out, cell,
                 arguments.recording.options(arguments.force), [&stop] { return stop.wait(0); });
  if (!result.error.empty()) {
    print(stderr, "clearance-record: {}\n", result.error);
    if (result.begun) remove_unfinished("clearance-record", arguments.out);
    return kFailed;
  }
  for (const std::string& object : result.fixed_objects) {
    print(stderr, "clearance-record: object '{}' is fixed in the cell: its rows were left out\n",
          object);
  }
  print(stdout, "{}: {} rows, {} objects, {} samples, {:.3f} s\n", arguments.out, result.rows,
        result.objects.size(), result.samples,
        static_cast<double>(result.last_ns - result.first_ns) * 1e-9);
  return kOk;
}

int record_from_log(const RecordArguments& arguments, const std::string& log, const Cell& cell,
                    StopSignal& stop) {
  InputLogOptions options{.joint_topics = arguments.joint_topics};
  if (const auto wrong = read_joint_positions(arguments.joints, options.joints); !wrong.empty()) {
    print(stderr, "clearance-record: {}\n", wrong);
    return kUsage;
  }
  const LogRecordingResult result =
      record_log(log, arguments.out, cell, options, arguments.recording.options(arguments.force),
                 [&stop] { return stop.wait(0); });
  for (const std::string& note : result.notes) {
    print(stderr, "clearance-record: {}\n", note);
  }
  for (const Sensor& sensor : cell.scene.sensors) {
    print(stderr,
          "clearance-record: what sensor '{}' saw is not in the recording: replay the bag itself "
          "for it\n",
          sensor.name);
  }
  if (!result.error.empty()) {
    print(stderr, "clearance-record: {}\n", result.error);
    if (result.begun) remove_unfinished("clearance-record", arguments.out);
    return kFailed;
  }
  print(stdout, "{}: {} batches, {:.3f} s\n", arguments.out, result.batches,
        static_cast<double>(result.last_ns - result.first_ns) * 1e-9);
  if (result.damage.empty()) return kOk;
  print(stderr, "clearance-record: {}\n", result.damage);
  return kIncomplete;
}

}  // namespace clearance
