// The answer to a question about a motion as diagnostics of ROS 2.
#pragma once

#include <string>

#include "monitor/interface/motion_question.hpp"
#include "monitor/publish/diagnostic_status.hpp"

namespace clearance {

// OK: the motion keeps all margins. WARN: that is not decided. ERROR: it does not keep one of them,
// or nothing is known of it. `motion` names it, "/arm/joint_trajectory".
[[nodiscard]] DiagnosticText motion_status(const std::string& motion, const QuestionResult& result);

}  // namespace clearance
