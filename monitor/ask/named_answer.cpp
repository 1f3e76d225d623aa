#include "monitor/ask/named_answer.hpp"

#include <cstddef>
#include <cstdint>

#include "monitor/ask/asker.hpp"

namespace clearance {

void name_answer(const Answer& answer, const Question& question, const Scene& scene,
                 QuestionResult& result) {
  const double end = question.motion.times.back();
  const auto name = [&](std::uint32_t object) { return object_name(scene, question, object); };
  result.without = sensors_left_out(question);
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
  for (std::size_t i = 0; i < answer.margins.size(); ++i) {
    const MarginAnswer& margin = answer.margins[i];
    MarginResult& out = result.margins.emplace_back();
    if (i >= question.margins.size()) {
      const MarginBetween& of = question.margins_between[i - question.margins.size()];
      out.a = of.a;
      out.b = of.b;
    }
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
      if (scaling.zone != TimeScaling::kNoZone) limit.zone = scene.zones[scaling.zone].name;
    }
  }
  result.within_work_limit = answer.within_work_limit;
  result.queries = answer.queries;
}

}  // namespace clearance
