#include <cstdio>

#include "monitor/app/program.hpp"
#include "monitor/csv/pose_log.hpp"
#include "tools/record/arguments.hpp"

namespace clearance {

int record_from_csv(const RecordArguments& arguments, const Scene* scene, StopSignal& stop) {
  const CsvRecordingResult result =
      record_csv(arguments.from_csv, arguments.out, scene, [&stop] { return stop.wait(0); });
  if (!result.error.empty()) {
    std::fprintf(stderr, "clearance-record: %s\n", result.error.c_str());
    if (result.begun) remove_unfinished("clearance-record", arguments.out);
    return kFailed;
  }
  for (const std::string& object : result.fixed_objects) {
    std::fprintf(stderr,
                 "clearance-record: object '%s' is fixed in the cell: its rows were left out\n",
                 object.c_str());
  }
  std::printf("%s: %zu rows, %zu objects, %zu samples, %.3f s\n", arguments.out.c_str(),
              result.rows, result.objects.size(), result.samples,
              static_cast<double>(result.last_ns - result.first_ns) * 1e-9);
  return kOk;
}

}  // namespace clearance
