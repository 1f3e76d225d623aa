#include "tools/view/asked_path.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/view/json_number.hpp"

namespace clearance::view {
namespace {

// More would hide each other.
constexpr std::size_t kFrames = 12;

// The first instant that does not keep a margin, or may not.
const MarginResult* first_violation(const QuestionResult& result) {
  const MarginResult* first = nullptr;
  const auto at = [](const MarginResult& margin) {
    return margin.verdict == Verdict::kBelow ? margin.below_at : margin.above_until;
  };
  for (const MarginResult& margin : result.margins) {
    if (margin.verdict == Verdict::kFree) continue;
    if (first == nullptr || at(margin) < at(*first)) first = &margin;
  }
  return first;
}

}  // namespace

bool AskedPath::take(const MotionQuestion& question, const ObjectPoses& poses) {
  asked_ = question;
  return draw(poses);
}

bool AskedPath::take(const QuestionResult& result, const ObjectPoses& poses) {
  result_ = result;
  return draw(poses);
}

bool AskedPath::draw(const ObjectPoses& poses) {
  if (!asked_ || !result_) return false;
  const QuestionResult& result = *result_;
  if (asked_->client != result.client || asked_->request != result.request) return false;
  json_ = {{"client", result.client},           {"request", result.request},
           {"status", name_of(result.status)},  {"reason", result.reason},
           {"lower", number(result.lower)},     {"upper", number(result.upper)},
           {"frames", nlohmann::json::array()}, {"violation", nullptr}};
  std::vector<double> more;
  const MarginResult* const violation = first_violation(result);
  if (violation != nullptr) {
    more.push_back(violation->verdict == Verdict::kBelow ? violation->below_at
                                                         : violation->above_until);
  }
  for (const PathFrame& frame : poses.along(asked_->question, kFrames, more)) {
    nlohmann::json links = nlohmann::json::array();
    for (const PathFrame::Placed& link : frame.links) {
      const Vec3& p = link.world_from_object.position;
      const Eigen::Quaterniond& q = link.world_from_object.orientation;
      links.push_back({link.object, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
    }
    if (!more.empty() && frame.time == more[0] && json_["violation"].is_null()) {
      json_["violation"] = {{"t", frame.time},
                            {"frame", json_["frames"].size()},
                            {"margin", violation->margin},
                            {"pair", {violation->first, violation->second}},
                            {"sure", violation->verdict == Verdict::kBelow}};
    }
    json_["frames"].push_back({{"t", frame.time}, {"links", std::move(links)}});
  }
  return true;
}

}  // namespace clearance::view
