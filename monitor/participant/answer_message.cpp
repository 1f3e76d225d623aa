#include <cmath>
#include <string>

#include "monitor/participant/question_message.hpp"
#include "monitor/participant/wire_values.hpp"

namespace clearance {
namespace {

clearance_msg_Vector3 vector_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vector_of(const clearance_msg_Vector3& v) { return {v.x, v.y, v.z}; }

}  // namespace

QuestionResult from_wire(const clearance_msg_Answer& message) {
  QuestionResult result{.client = message.client,
                        .request = message.request,
                        .status = static_cast<QuestionStatus>(message.status),
                        .path = std::string(text_of(message.path)),
                        .reason = std::string(text_of(message.reason)),
                        .scene_revision = message.scene_revision,
                        .cycle = message.cycle,
                        .now_ns = message.now_ns,
                        .lower = message.lower,
                        .upper = message.upper,
                        .time = message.time,
                        .first = std::string(text_of(message.first)),
                        .second = std::string(text_of(message.second)),
                        .point_on_first = vector_of(message.point_on_first),
                        .point_on_second = vector_of(message.point_on_second),
                        .within_work_limit = message.within_work_limit,
                        .queries = message.queries,
                        .start_deviation = message.start_deviation,
                        .start_joint = std::string(text_of(message.start_joint))};
  for (std::uint32_t i = 0; i < message.margins._length; ++i) {
    const clearance_msg_MarginVerdict& from = message.margins._buffer[i];
    const auto verdict = static_cast<Verdict>(from.verdict);
    const bool is_known = verdict == Verdict::kFree || verdict == Verdict::kBelow;
    result.margins.push_back({.margin = from.margin,
                              .verdict = is_known ? verdict : Verdict::kUndecided,
                              .above_until = from.above_until,
                              .below_at = from.below_at,
                              .first = std::string(text_of(from.first)),
                              .second = std::string(text_of(from.second)),
                              .a = std::string(text_of(from.a)),
                              .b = std::string(text_of(from.b))});
  }
  for (std::uint32_t i = 0; i < message.profile._length; ++i) {
    const clearance_msg_ProfilePart& from = message.profile._buffer[i];
    result.profile.push_back({.from = from.begin,
                              .to = from.end,
                              .lower = from.lower,
                              .upper = from.upper,
                              .first = std::string(text_of(from.first)),
                              .second = std::string(text_of(from.second))});
  }
  if (!std::isnan(message.time_factor)) {
    result.time_limit = TimeLimit{.is_limited = message.is_time_limited,
                                  .factor = message.time_factor,
                                  .factor_above = message.time_factor_above,
                                  .time = message.time_limit_at,
                                  .first = std::string(text_of(message.time_limit_first)),
                                  .second = std::string(text_of(message.time_limit_second)),
                                  .zone = std::string(text_of(message.time_limit_zone))};
  }
  return result;
}

Sample<clearance_msg_Answer> to_wire(const QuestionResult& result, std::uint64_t daemon) {
  Sample<clearance_msg_Answer> message;
  copy_text(result.client, message->client);
  message->request = result.request;
  message->daemon = daemon;
  message->status = static_cast<std::uint8_t>(result.status);
  put_value(result.path, message->path);
  put_value(result.reason, message->reason);
  message->scene_revision = result.scene_revision;
  message->cycle = result.cycle;
  message->now_ns = result.now_ns;
  message->lower = result.lower;
  message->upper = result.upper;
  message->time = result.time;
  put_value(result.first, message->first);
  put_value(result.second, message->second);
  message->point_on_first = vector_of(result.point_on_first);
  message->point_on_second = vector_of(result.point_on_second);
  put_list(result.margins, message->margins,
           [](const MarginResult& from, clearance_msg_MarginVerdict& to) {
             to.margin = from.margin;
             to.verdict = static_cast<std::uint8_t>(from.verdict);
             to.above_until = from.above_until;
             to.below_at = from.below_at;
             put_value(from.first, to.first);
             put_value(from.second, to.second);
             put_value(from.a, to.a);
             put_value(from.b, to.b);
           });
  put_list(result.profile, message->profile,
           [](const ProfilePart& from, clearance_msg_ProfilePart& to) {
             to.begin = from.from;
             to.end = from.to;
             to.lower = from.lower;
             to.upper = from.upper;
             put_value(from.first, to.first);
             put_value(from.second, to.second);
           });
  const TimeLimit limit =
      result.time_limit.value_or(TimeLimit{.factor = QuestionResult::kNotKnown,
                                           .factor_above = QuestionResult::kNotKnown,
                                           .time = QuestionResult::kNotKnown});
  message->is_time_limited = limit.is_limited;
  message->time_factor = limit.factor;
  message->time_factor_above = limit.factor_above;
  message->time_limit_at = limit.time;
  put_value(limit.first, message->time_limit_first);
  put_value(limit.second, message->time_limit_second);
  put_value(limit.zone, message->time_limit_zone);
  message->within_work_limit = result.within_work_limit;
  message->queries = result.queries;
  message->start_deviation = result.start_deviation;
  put_value(result.start_joint, message->start_joint);
  return message;
}

}  // namespace clearance
