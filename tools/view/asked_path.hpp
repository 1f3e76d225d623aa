// The motion that a client has asked a daemon about, and the answer, for the page.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "monitor/interface/motion_question.hpp"
#include "monitor/visual/object_poses.hpp"

namespace clearance::view {

class AskedPath {
 public:
  // A question and its answer come in either order. Each returns true if the last question is now
  // answered. The joints that the question does not state are then where `poses` has them.
  bool take(const MotionQuestion& question, const ObjectPoses& poses);
  bool take(const QuestionResult& result, const ObjectPoses& poses);

  // Null before the first answer. Otherwise client, request, status, reason, lower, upper; frames:
  // [{t, links: [[object, x, y, z, qx, qy, qz, qw], ...]}]; violation: null, or {t, frame (an index
  // into frames), margin, pair, sure (false: undecided)}. Infinities are null.
  [[nodiscard]] const nlohmann::json& json() const noexcept { return json_; }

 private:
  bool draw(const ObjectPoses& poses);

  std::optional<MotionQuestion> asked_;   // the last one
  std::optional<QuestionResult> result_;  // the last one
  nlohmann::json json_;
};

}  // namespace clearance::view
