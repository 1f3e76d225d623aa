#include "monitor/ask/named_answer.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace clearance {
namespace {

// New objects follow those of the scene, in the order of the question.
std::string new_payload(const Question& question, const Scene& scene, std::uint32_t object) {
  std::size_t place = object - scene.objects.size();
  for (const Payload& payload : question.payloads) {
    const bool is_new =
        std::ranges::find(scene.objects, payload.name, &Object::name) == scene.objects.end();
    if (is_new && place-- == 0) return payload.name;
  }
  return "";
}

}  // namespace

void name_answer(const Answer& answer, const Question& question, const Scene& scene,
                 QuestionResult& result) {
  const double end = question.motion.times.back();
  const std::size_t objects = scene.objects.size();
  const auto name = [&](std::uint32_t object) {
    return object < objects ? scene.objects[object].name : new_payload(question, scene, object);
  };
  result.lower = answer.lower;
  result.upper = answer.upper;
  if (answer.has_pair && answer.upper < kInfinity) {
    result.time = answer.time;
    result.first = name(answer.first);
    result.second = name(answer.second);
    if (answer.upper > 0.0) {
      result.point_on_first = answer.point_on_first;
      result.point_on_second = answer.point_on_second;
    }
  }
  for (const MarginAnswer& margin : answer.margins) {
    MarginResult& out = result.margins.emplace_back();
    out.margin = margin.margin;
    out.verdict = margin.verdict;
    out.above_until = margin.verdict == Verdict::kFree ? end : margin.above_until;
    out.below_at = margin.verdict == Verdict::kBelow ? margin.below_at : QuestionResult::kNotKnown;
    if (margin.verdict == Verdict::kFree) continue;
    out.first = name(margin.first);
    out.second = name(margin.second);
  }
  for (const ProfilePoint& point : answer.profile) {
    result.profile.push_back({.from = point.from,
                              .to = point.to,
                              .lower = point.lower,
                              .upper = point.upper,
                              .first = name(point.first),
                              .second = name(point.second)});
  }
  if (question.time_scaling) {
    const TimeScaling& scaling = answer.scaling;
    TimeLimit& limit = result.time_limit.emplace();
    limit.is_limited = scaling.is_limited;
    limit.factor = scaling.factor;
    limit.factor_above = scaling.factor_above;
    limit.time = scaling.time;
    if (scaling.factor_above < kInfinity) {
      limit.first = name(scaling.first);
      limit.second = name(scaling.second);
      limit.zone = scene.zones[scaling.zone].name;
    }
  }
  result.within_work_limit = answer.within_work_limit;
  result.queries = answer.queries;
}

}  // namespace clearance
