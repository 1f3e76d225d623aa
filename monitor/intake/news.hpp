// What a person should know of what comes in, each once: a sentence, and its cause for programs.
#pragma once

#include <cstdint>
#include <string>

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
    kNoTransforms,  // none has come at all; the sentence leaves room for what there is instead
    kFrameFound,
  };
  Cause cause;
  bool is_warning = true;  // false: merely of interest
  std::string text;
};

}  // namespace clearance
