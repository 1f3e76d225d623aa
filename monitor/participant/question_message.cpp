#include "monitor/participant/question_message.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "monitor/participant/body_message.hpp"
#include "monitor/participant/wire_values.hpp"

namespace clearance {
namespace {

// Reads fields until one has no valid value.
class Reader {
 public:
  [[nodiscard]] std::optional<MalformedField> fault() && { return std::move(fault_); }

  void name(const std::string& path, const char* from, std::string& to, bool may_be_empty = false) {
    const std::string_view text = text_of(from);
    if (auto fault = fault_of_text(text, kLongestName, may_be_empty))
      return refuse(path, *std::move(fault));
    to = text;
  }
  void number(const std::string& path, double from, double& to) {
    if (!std::isfinite(from)) return refuse(path, not_finite(from));
    to = from;
  }
  // The same as number(), but 0 leaves what is there.
  void number_or_default(const std::string& path, double from, double& to) {
    if (from != 0.0) number(path, from, to);
  }
  void from_zero(const std::string& path, double from, double& to) {
    if (!(from >= 0.0) || !std::isfinite(from))
      return refuse(path, fmt::format("found {}; expected a finite number from 0 on", from));
    to = from;
  }
  // A number that is not stated leaves what is there.
  void stated(const std::string& path, const clearance_msg_StatedNumber& from, double& to) {
    if (from.is_stated) number(path, from.value, to);
  }
  void body(const std::string& path, const clearance_msg_StatedBody& from,
            std::optional<ConvexBody>& to) {
    auto made = from_wire(from);
    if (auto* error = std::get_if<ShapeError>(&made)) return refuse(path, std::move(error->reason));
    to = std::get<0>(std::move(made));
  }
  void pose(const std::string& path, const clearance_msg_Placement& from, Pose& to) {
    if (auto fault = take_placement(from, to))
      refuse(fmt::format("{}.{}", path, fault->field), std::move(fault->reason));
  }
  // Calls read(path of the entry, entry of the message, entry of `to`) for each entry.
  template <class Sequence, class To, class Read>
  void list(const std::string& path, const Sequence& from, std::size_t most, std::vector<To>& to,
            const Read& read) {
    if (from._length > most) {
      return refuse(path, fmt::format("found {} entries; expected at most {}", from._length, most));
    }
    to.resize(from._length);
    for (std::uint32_t i = 0; i < from._length && !fault_; ++i)
      read(fmt::format("{}[{}]", path, i), from._buffer[i], to[i]);
  }
  void names(const std::string& path, const dds_sequence_string& from, std::size_t most,
             std::vector<std::string>& to) {
    list(path, from, most, to, [this](const std::string& at, const char* text, std::string& out) {
      name(at, text, out);
    });
  }
  // The path of an entry is made only when it is needed.
  void numbers(const std::string& path, const dds_sequence_double& from, std::size_t most,
               std::vector<double>& to) {
    if (from._length > most) {
      return refuse(path, fmt::format("found {} entries; expected at most {}", from._length, most));
    }
    for (std::uint32_t i = 0; i < from._length; ++i) {
      if (!std::isfinite(from._buffer[i]))
        return refuse(fmt::format("{}[{}]", path, i), not_finite(from._buffer[i]));
    }
    if (from._length > 0) to.assign(from._buffer, from._buffer + from._length);
  }
  void motion(const std::string& path, const clearance_msg_JointMotion& from, JointTrajectory& to) {
    names(path + ".joints", from.joints, kMostMotionJoints, to.joints);
    numbers(path + ".times", from.times, kMostWaypoints, to.times);
    const std::size_t most = to.times.size() * to.joints.size();
    numbers(path + ".positions", from.positions, most, to.positions);
    numbers(path + ".velocities", from.velocities, most, to.velocities);
  }
  void refuse(const std::string& path, std::string reason) {
    if (!fault_) fault_ = MalformedField{0, path, std::move(reason)};
  }

 private:
  std::optional<MalformedField> fault_;
};

void put_motion(const JointTrajectory& from, clearance_msg_JointMotion& to) {
  put_value(from.joints, to.joints);
  put_value(from.times, to.times);
  put_value(from.positions, to.positions);
  put_value(from.velocities, to.velocities);
}

// Infinity is not stated. A value that is no number is stated, so that it is refused.
clearance_msg_StatedNumber stated_number(double value) { return {value != kInfinity, value}; }

void read_profile(const clearance_msg_Question& message, Reader& read, Question& question) {
  if (message.profile == 0) return;
  ProfileRequest& profile = question.profile.emplace();
  if (message.profile > kMostProfile) {
    read.refuse("profile",
                fmt::format("found {}; expected at most {} points", message.profile, kMostProfile));
  }
  profile.most_points = message.profile;
  read.number_or_default("profile_tolerance", message.profile_tolerance, profile.tolerance);
  read.name("profile_first", message.profile_first, profile.first, true);
  read.name("profile_second", message.profile_second, profile.second, true);
}

void read_contacts(const clearance_msg_Question& message, Reader& read, Question& question) {
  if (!message.states_contacts) return;
  read.list("contacts", message.contacts, kMostStated, question.contacts.emplace(),
            [&](const std::string& at, const clearance_msg_MeantContact& from, MeantContact& to) {
              read.name(at + ".first", from.first, to.first);
              read.name(at + ".second", from.second, to.second);
              read.number(at + ".depth", from.depth, to.depth);
              read.stated(at + ".until", from.until, to.until);
              read.stated(at + ".distance", from.distance, to.distance);
            });
}

void read_others(const clearance_msg_Question& message, Reader& read, Question& question) {
  read.list("poses", message.poses, kMostStated, question.poses,
            [&](const std::string& at, const clearance_msg_PlacedObject& from, StatedPose& to) {
              read.name(at + ".object", from.object, to.object);
              read.pose(at + ".world_from_object", from.world_from_object, to.world_from_object);
              read.from_zero(at + ".age", from.age, to.age);
              if (from.turn_speed.is_stated)
                read.from_zero(at + ".turn_speed", from.turn_speed.value, to.turn_speed);
            });
  read.list("joints", message.joints, kMostStated, question.joints,
            [&](const std::string& at, const clearance_msg_PlacedJoint& from, StatedJoint& to) {
              read.name(at + ".joint", from.joint, to.name);
              read.number(at + ".position", from.position, to.position);
              read.from_zero(at + ".age", from.age, to.age);
            });
  read.list("moving", message.moving, kMostStated, question.moving,
            [&](const std::string& at, const clearance_msg_ObjectMotion& from, ObjectMotion& to) {
              read.name(at + ".object", from.object, to.object);
              read.numbers(at + ".times", from.times, kMostWaypoints, to.times);
              read.list(at + ".world_from_object", from.world_from_object, kMostWaypoints,
                        to.world_from_object,
                        [&](const std::string& path, const clearance_msg_Placement& each,
                            Pose& pose) { read.pose(path, each, pose); });
            });
  read.list("payloads", message.payloads, kMostStated, question.payloads,
            [&](const std::string& at, const clearance_msg_CarriedObject& from, Payload& to) {
              read.name(at + ".object", from.object, to.name);
              read.name(at + ".link", from.link, to.link);
              read.pose(at + ".link_from_object", from.link_from_object, to.link_from_object);
              read.names(at + ".touch", from.touch, kMostStated, to.touch);
              read.body(at + ".body", from.body, to.shape);
            });
  constexpr auto kLast = static_cast<std::uint8_t>(OthersMove::kNot);
  if (message.others > kLast)
    read.refuse("others", fmt::format("found {}; expected 0 to {}", message.others, kLast));
  question.others = static_cast<OthersMove>(message.others);
}

}  // namespace

std::variant<MotionQuestion, MalformedField> from_wire(const clearance_msg_Question& message) {
  MotionQuestion asked{.client = message.client,
                       .request = message.request,
                       .scene_revision = message.scene_revision};
  Reader read;
  if (asked.client.empty() || end_of_utf8(asked.client) != asked.client.size())
    read.refuse("client", "found no name in UTF-8; expected one of 1 to 32 bytes");
  if (asked.request == 0)
    read.refuse("request", "found 0; expected a number from 1 that counts up");
  Question& question = asked.question;
  read.motion("motion", message.motion, question.motion);
  read.list("beside", message.beside, kMostMotions, question.beside,
            [&](const std::string& at, const clearance_msg_JointMotion& from, JointTrajectory& to) {
              read.motion(at, from, to);
            });
  read.list("held", message.held, kMostStated, question.held,
            [&](const std::string& at, const clearance_msg_HeldJoint& from, HeldJoint& to) {
              read.name(at + ".joint", from.joint, to.name);
              read.number(at + ".position", from.position, to.position);
            });
  read_others(message, read, question);
  read_contacts(message, read, question);
  question.margins.clear();
  read.numbers("margins", message.margins, kMostMargins, question.margins);
  read.list("margins_between", message.margins_between, kMostMargins, question.margins_between,
            [&](const std::string& at, const clearance_msg_MarginBetween& from, MarginBetween& to) {
              read.name(at + ".a", from.a, to.a);
              read.name(at + ".b", from.b, to.b, true);
              read.number(at + ".margin", from.margin, to.margin);
            });
  read.number_or_default("tolerance", message.tolerance, question.tolerance);
  question.only_margins = message.only_margins;
  read_profile(message, read, question);
  question.time_scaling = message.time_scaling;
  question.stoppable = message.stoppable;
  question.work_limit = message.work_limit;
  if (auto fault = std::move(read).fault()) return *std::move(fault);
  return asked;
}

std::string unsent_part(const Question& question) {
  if (!question.seen.empty())
    return "seen: a daemon has the frames of its sensors from its inputs; leave them out";
  for (const Payload& payload : question.payloads) {
    if (!payload.shape) continue;
    if (std::string unsent = unsent_part(*payload.shape); !unsent.empty())
      return "payloads: " + std::move(unsent);
  }
  return "";
}

Sample<clearance_msg_Question> to_wire(const MotionQuestion& asked) {
  Sample<clearance_msg_Question> message;
  copy_text(asked.client, message->client);
  message->request = asked.request;
  message->scene_revision = asked.scene_revision;
  const Question& question = asked.question;
  put_motion(question.motion, message->motion);
  put_list(question.beside, message->beside, put_motion);
  put_list(question.held, message->held, [](const HeldJoint& from, clearance_msg_HeldJoint& to) {
    put_value(from.name, to.joint);
    to.position = from.position;
  });
  put_list(question.poses, message->poses,
           [](const StatedPose& from, clearance_msg_PlacedObject& to) {
             put_value(from.object, to.object);
             put_value(from.world_from_object, to.world_from_object);
             to.age = from.age;
             to.turn_speed = stated_number(from.turn_speed);
           });
  put_list(question.joints, message->joints,
           [](const StatedJoint& from, clearance_msg_PlacedJoint& to) {
             put_value(from.name, to.joint);
             to.position = from.position;
             to.age = from.age;
           });
  put_list(question.moving, message->moving,
           [](const ObjectMotion& from, clearance_msg_ObjectMotion& to) {
             put_value(from.object, to.object);
             put_value(from.times, to.times);
             put_list(from.world_from_object, to.world_from_object,
                      [](const Pose& pose, clearance_msg_Placement& out) { put_value(pose, out); });
           });
  put_list(question.payloads, message->payloads,
           [](const Payload& from, clearance_msg_CarriedObject& to) {
             put_value(from.name, to.object);
             put_value(from.link, to.link);
             put_value(from.link_from_object, to.link_from_object);
             put_value(from.touch, to.touch);
             if (from.shape) put_value(*from.shape, to.body);
           });
  message->states_contacts = question.contacts.has_value();
  if (question.contacts) {
    put_list(*question.contacts, message->contacts,
             [](const MeantContact& from, clearance_msg_MeantContact& to) {
               put_value(from.first, to.first);
               put_value(from.second, to.second);
               to.depth = from.depth;
               to.until = stated_number(from.until);
               to.distance = stated_number(from.distance);
             });
  }
  message->others = static_cast<std::uint8_t>(question.others);
  put_value(question.margins, message->margins);
  put_list(question.margins_between, message->margins_between,
           [](const MarginBetween& from, clearance_msg_MarginBetween& to) {
             put_value(from.a, to.a);
             put_value(from.b, to.b);
             to.margin = from.margin;
           });
  message->tolerance = question.tolerance;
  message->only_margins = question.only_margins;
  const ProfileRequest profile = question.profile.value_or(ProfileRequest());
  message->profile = question.profile ? profile.most_points : 0;
  message->profile_tolerance = profile.tolerance;
  put_value(profile.first, message->profile_first);
  put_value(profile.second, message->profile_second);
  message->time_scaling = question.time_scaling;
  message->stoppable = question.stoppable;
  message->work_limit = question.work_limit;
  return message;
}

}  // namespace clearance
