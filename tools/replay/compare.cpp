#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

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

std::string text_of(const std::vector<RecordingsDifference::Stretch>& stretches) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, stretches.size()); ++i)
    text += fmt::format("{}{} to {}", i == 0 ? "" : ", ", stretches[i].first, stretches[i].last);
  if (stretches.size() > kShown) {
    text += fmt::format(" and {} more stretches to {}", stretches.size() - kShown,
                        stretches.back().last);
  }
  return text.empty() ? "none" : text;
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
  print(stdout, "{} cycles compared, {}\n", found.compared, text_of(found.stretches));
  if (found.left_out != std::array<std::uint64_t, 2>{}) {
    print(
        stdout,
        "left out before the last of these: {} cycles of {}, {} of {}, with inputs or numbers that "
        "the other one does not have\n",
        found.left_out[0], arguments.first, found.left_out[1], arguments.second);
  }
  if (!found.is_same()) {
    print(stdout, "first difference: cycle {} (now_ns {}): {}: {}\n", found.cycle, found.now_ns,
          meaning_of(found.kind), found.what);
    return kFailed;
  }
  print(stdout, "no difference\n");
  return found.stopped || !found.damage.empty() ? kIncomplete : kOk;
}

}  // namespace clearance
