// News about the inputs for a person, each told once: a sentence, and its cause for programs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace clearance {

struct News {
  enum class Cause : std::uint8_t {
    kNewSource,
    kSourceTakenOver,
    kSourceRefused,
    kOtherRevision,
    kSlowInput,
    kOtherClock,
    kTopicHeard,
    kTooManyTopics,
    kNoPositions,
    kUnknownJoints,
    kFrameRefused,
    kTooManyFrames,
    kFrameOfTwo,
    kFrameMoved,
    kFrameMissing,
    kNoTransforms,  // none at all; the caller adds to the sentence what there is instead
    kFrameFound,
  };
  Cause cause;
  bool is_warning = true;  // false: information only
  std::string text;
};

// "'arm'", or "(no name)" for an empty name.
[[nodiscard]] std::string quoted(std::string_view name);

// The code at the end of the daemon's log line, as of the lines in monitor/app/log_lines.hpp.
[[nodiscard]] const char* code(News::Cause cause) noexcept;

}  // namespace clearance
