#include "monitor/intake/news.hpp"

#include <fmt/format.h>

namespace clearance {

std::string quoted(std::string_view name) {
  return name.empty() ? "(no name)" : fmt::format("'{}'", name);
}

// Codes do not change, because tests, FAULTS.md and other programs look for them.
const char* code(News::Cause cause) noexcept {
  switch (cause) {
    case News::Cause::kNewSource:
      return "new-source";
    case News::Cause::kSourceTakenOver:
      return "source-taken-over";
    case News::Cause::kSourceRefused:
      return "source-refused";
    case News::Cause::kOtherRevision:
      return "other-revision";
    case News::Cause::kSlowInput:
      return "slow-input";
    case News::Cause::kOtherClock:
      return "other-clock";
    case News::Cause::kTopicHeard:
      return "topic-heard";
    case News::Cause::kTooManyTopics:
      return "too-many-topics";
    case News::Cause::kNoPositions:
      return "no-positions";
    case News::Cause::kUnknownJoints:
      return "unknown-joints";
    case News::Cause::kFrameRefused:
      return "frame-refused";
    case News::Cause::kTooManyFrames:
      return "too-many-frames";
    case News::Cause::kFrameOfTwo:
      return "frame-of-two";
    case News::Cause::kFrameMoved:
      return "frame-moved";
    case News::Cause::kFrameMissing:
      return "frame-missing";
    case News::Cause::kNoTransforms:
      return "no-transforms";
    case News::Cause::kFrameFound:
      return "frame-found";
  }
  return "news";
}

}  // namespace clearance
