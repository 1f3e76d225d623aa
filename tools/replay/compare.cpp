#include <cstdio>
#include <string_view>

#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/replay/recordings_difference.hpp"
#include "tools/replay/arguments.hpp"

namespace clearance {
namespace {

std::string_view meaning_of(RecordingsDifference::Kind kind) {
  using Kind = RecordingsDifference::Kind;
  switch (kind) {
    case Kind::kSame:
      break;
    case Kind::kMissing:
      return "a report is missing";
    case Kind::kScene:
      return "the scenes differ";
    case Kind::kInputs:
      return "the inputs differ";
    case Kind::kTime:
      return "the ticks were given different times";
    case Kind::kResult:
      return "the results differ, and the inputs of this cycle do not";
  }
  return {};
}

}  // namespace

int compare_two_recordings(const CompareArguments& arguments, StopSignal& stop) {
  const RecordingsDifference found =
      compare_recordings(arguments.first, arguments.second, [&stop] { return stop.wait(0); });
  if (!found.error.empty()) {
    print(stderr, "clearance-replay: {}\n", found.error);
    return kFailed;
  }
  if (!found.damage.empty()) print(stderr, "clearance-replay: {}\n", found.damage);
  print(stdout, "{} cycles compared, {} to {}\n", found.compared, found.first_cycle,
        found.last_cycle);
  if (!found.is_same()) {
    print(stdout, "first difference: cycle {} (now_ns {}): {}: {}\n", found.cycle, found.now_ns,
          meaning_of(found.kind), found.what);
    return kFailed;
  }
  print(stdout, "no difference\n");
  return found.stopped || !found.damage.empty() ? kIncomplete : kOk;
}

}  // namespace clearance
