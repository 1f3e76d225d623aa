#include "monitor/interface/contact_text.hpp"

#include <cstdio>

namespace clearance {
namespace {

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", 1e3 * metres);
  return text;
}

std::string ended_text(const ContactReport& state) {
  const std::string cycle = " at cycle " + std::to_string(state.ended_cycle);
  switch (state.ended) {
    case ContactEnded::kNot:
      return "";
    case ContactEnded::kByDistance:
      return "ended by distance" + cycle;
    case ContactEnded::kByTime:
      return "ended by time" + cycle;
    case ContactEnded::kByCycle:
      return "ended by cycle" + cycle;
  }
  return "";
}

std::string depth_text(const AllowedContact& contact, const ContactReport& state) {
  return millimetres(state.depth) + " of " + millimetres(contact.depth) + " mm deep";
}

}  // namespace

std::string end_text(const ContactEnd& end) {
  std::string text;
  const auto add = [&](const std::string& condition) {
    text += (text.empty() ? "until " : " or ") + condition;
  };
  if (end.distance < kInfinity) add("the distance is " + millimetres(end.distance) + " mm");
  if (end.duration_ns != ContactEnd::kNoTime)
    add("it has lasted " + std::to_string(end.duration_ns / 1'000'000) + " ms");
  if (end.time_ns != ContactEnd::kNoTime) add("time " + std::to_string(end.time_ns) + " ns");
  if (end.last_cycle != ContactEnd::kNoCycle) add("cycle " + std::to_string(end.last_cycle));
  return text.empty() ? "until it is withdrawn" : text;
}

std::string contact_text(const AllowedContact& contact, const ContactReport& state) {
  const std::string subject = "contact '" + contact.name + "' ";
  const std::string terms =
      ", since cycle " + std::to_string(state.since_cycle) + ", " + end_text(contact.end);
  switch (state.status) {
    case ContactStatus::kUnknown:
      return subject + "not known: poses are missing or late";
    case ContactStatus::kAllowed:
      return subject + "allowed by " + contact.by + ": " + depth_text(contact, state) + terms;
    case ContactStatus::kTooDeep:
      return subject + "deeper than allowed by " + contact.by + ": " + depth_text(contact, state) +
             terms;
    case ContactStatus::kEnded:
      return subject + ended_text(state);
    case ContactStatus::kTooLate:
      return subject + "later than allowed by " + contact.by + ": " + ended_text(state);
    case ContactStatus::kAbsent:
      return subject + "without an object that is present";
  }
  return subject + "of a status that this build does not know";
}

}  // namespace clearance
