// Questions and answers as messages of idl/questions.idl, in both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "monitor/interface/motion_question.hpp"
#include "monitor/participant/command_message.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The most entries of a message. More are refused.
inline constexpr std::size_t kMostWaypoints = 10'000, kMostMotionJoints = 64, kMostMotions = 16,
                             kMostStated = 1024, kMostMargins = 16, kMostProfile = 10'000;

// Reads a message. Its client must be readable as text in any case. Refused are more entries than
// there is room for, numbers that are not finite, quaternions that are not of unit length, texts
// that are empty, too long, or no UTF-8, and codes that do not exist.
[[nodiscard]] std::variant<MotionQuestion, MalformedField> from_wire(
    const clearance_msg_Question& message);

// Returns what a message has no room for, as "NAME: what to do instead"; empty: all of the question
// can be sent. A daemon has the frames of sensors from its inputs.
[[nodiscard]] std::string unsent_part(const Question& question);

// Makes the message of a question. It allocates. The longest client has 32 bytes; more are cut off.
// The question must be one that unsent_part() finds complete.
[[nodiscard]] Sample<clearance_msg_Question> to_wire(const MotionQuestion& question);

// Answers. `daemon` as in all messages of a daemon. A verdict that is not known is undecided.
[[nodiscard]] QuestionResult from_wire(const clearance_msg_Answer& message);
[[nodiscard]] Sample<clearance_msg_Answer> to_wire(const QuestionResult& result,
                                                   std::uint64_t daemon);

}  // namespace clearance
