#include <cstdio>

#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/recording/csv_recording.hpp"
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

}  // namespace clearance
