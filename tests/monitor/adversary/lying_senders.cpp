#include "tests/monitor/adversary/lying_senders.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "monitor/wire/convert.hpp"
#include "tests/monitor/recording/ros_bags.hpp"

namespace clearance::test::lies {
namespace {

constexpr std::uint64_t kOwners = 100, kRivals = 200, kMapMaker = 300,
                        kSimulation = 302;  // writers
constexpr const char* kTfType = "tf2_msgs/msg/TFMessage";
constexpr double kFarAway = 50.0;  // m
constexpr int kMostLost = 3;       // messages of a channel in a row
// How far the second value of a joint in one message is from the first one, rad.
constexpr double kOtherValue = 1.0;

std::size_t index(Channel channel) { return static_cast<std::size_t>(channel); }
std::uint64_t writer_of(Channel channel, bool is_rival) {
  return (is_rival ? kRivals : kOwners) + index(channel);
}

FrameText frame_text(const std::string& parent, const std::string& child, const Pose& pose) {
  const auto& [p, q] = std::pair(pose.position, pose.orientation);
  return {parent, child, {p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

const char* child_of(Channel channel) {
  if (channel == Channel::kOdom) return "odom";
  if (channel == Channel::kEye) return "eye_link";
  return channel == Channel::kBase ? "base_link" : "follower_link";
}

}  // namespace

LyingSenders::LyingSenders(const Scene& scene, const TrueMotion& truth, const Sending& sending,
                           std::int64_t start_ns, Intake& intake, Keep keep)
    : scene_(scene),
      truth_(truth),
      sending_(sending),
      start_ns_(start_ns),
      intake_(intake),
      keep_(std::move(keep)),
      random_(sending.seed + 2000) {
  for (bool& sends : sends_velocities_) sends = random_.chance(0.5);
  for (bool& by_ros : by_ros_) by_ros = random_.chance(0.5);
  for (std::int64_t& period : period_) period = random_.integer(1, 2) * kMs;
  period_[index(Channel::kPoints)] = period_[index(Channel::kPicture)] = kPicturePeriod;
  period_[index(Channel::kMap)] = kMapPeriod;
}

void LyingSenders::send(std::int64_t t) {
  keep_writers(t);
  if (sending_.factor) in_flight_.emplace(t, clock(t));
  if (t == 0) {
    const RosMessage far =
        transforms(start_ns_, start_ns_, {{"map", "far", {kFarAway, 0, 0}}}, "/tf_static");
    in_flight_.emplace(t, Message{t, topic("/tf_static", kTfType), kMapMaker, start_ns_, far.cdr});
    in_flight_.emplace(t, camera_info(t));
  }
  for (std::size_t i = 0; i < kChannels; ++i) {
    const auto channel = static_cast<Channel>(i);
    const Fault* const fault = fault_of(channel);
    if (fault != nullptr) {
      const Rival other = rival(*fault, t);
      if (other.speaks) speak_as_rival(channel, other, t);
    }
    if (is_sent(channel) && t % period_[i] == 0) speak(channel, t);
  }
  deliver(t);
}

// Tells the intake which writers exist, as discovery does.
void LyingSenders::keep_writers(std::int64_t t) {
  std::vector<std::uint64_t> writers{kMapMaker, kCameraDriver};
  for (std::size_t i = 0; i < kChannels; ++i) {
    const auto channel = static_cast<Channel>(i);
    const Fault* const fault = fault_of(channel);
    const bool is_first = fault != nullptr && fault->lie == Lie::kRivalFirst;
    if (!is_first || t >= kOwnerStarts) writers.push_back(writer_of(channel, false));
    if (fault != nullptr && rival(*fault, t).is_matched)
      writers.push_back(writer_of(channel, true));
  }
  if (writers == writers_) return;
  writers_ = writers;
  intake_.keep(writers);
  keep_(writers);
}

const Fault* LyingSenders::fault_of(Channel channel) const {
  const auto found = std::ranges::find(sending_.faults, channel, &Fault::channel);
  return found == sending_.faults.end() ? nullptr : &*found;
}

void LyingSenders::speak(Channel channel, std::int64_t t) {
  const Fault* const fault = fault_of(channel);
  const Told said = fault != nullptr ? told(*fault, t) : Told{.value_at = t};
  // A picture that was lost is new when it is repeated.
  const bool repeats = fault != nullptr && is_seen(channel) &&
                       (fault->lie == Lie::kRing || fault->lie == Lie::kFreezeAtRest);
  int& lost = lost_in_a_row_[index(channel)];
  const bool is_lost =
      t > kSecond / 5 && random_.chance(sending_.loss) && !repeats && lost < kMostLost;
  lost = is_lost ? lost + 1 : 0;
  if (said.is_silent || is_lost) return;
  post(message(channel, words(channel, said, t), false), t, said, channel);
}

void LyingSenders::speak_as_rival(Channel channel, const Rival& rival, std::int64_t t) {
  Told said{.value_at = rival.value_at};
  said.offset = rival.offset;
  said.joint_offset = rival.joint_offset;
  Words spoken = words(channel, said, t);
  if (rival.is_zero) spoken.joints = {};
  if (rival.is_of_one_joint) spoken.told_joints = 1;
  spoken.is_static = rival.is_static;
  Message sent = message(channel, spoken, true);
  sent.writer = writer_of(channel, true);
  sent.due = t;
  sent.sent_ns = start_ns_ + sending_.machine_time(t);
  in_flight_.emplace(t, std::move(sent));
}

LyingSenders::Words LyingSenders::words(Channel channel, const Told& told, std::int64_t t) const {
  Words words;
  words.stamp_ns = start_ns_ + t + told.stamp_offset;
  words.has_velocities = told.velocities.value_or(sends_velocities_[index(channel)]);
  words.quaternion_scale = told.quaternion_scale;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (is_robot(channel)) {
    const auto moving = truth_.joints(channel, t);
    std::ranges::copy(truth_.joints(channel, told.value_at), words.joints.begin());
    for (std::size_t i = 0; i < kJoints; ++i) {
      TrueJoint& joint = words.joints[i];
      const bool turns = i < 3;
      if (i == 2 && (told.is_wrapped || sending_.wraps)) {
        joint.position = std::remainder(joint.position, 2.0L * std::numbers::pi_v<long double>);
      }
      joint.position =
          (joint.position + told.joint_offset[i]) * (turns ? told.angle_scale : told.length_scale);
      joint.velocity = moving[i].velocity * told.velocity_scale;
      if (told.is_nan) joint.position = nan;
    }
    if (told.has_joint_twice) {
      words.joints.back() = words.joints.front();
      words.joints.back().position += kOtherValue;
      words.told_joints = words.joints.size();
    }
    words.has_too_few = told.has_too_few;
    return words;
  }
  if (is_seen(channel)) {
    see(channel, told, t, words);
    return words;
  }
  words.pose = truth_.pose(channel, told.value_at);
  words.pose.col(3).head<3>() += told.offset.cast<long double>();
  words.pose.col(3).head<3>() *= told.length_scale;
  if (told.is_turned) words.pose.leftCols<2>() *= -1.0L;
  if (told.is_nan) words.pose(0, 3) = nan;
  if (is_ball(channel)) {
    words.twist = truth_.twist(channel, t);
    words.twist.linear *= told.velocity_scale;
    words.twist.angular *= told.velocity_scale;
  }
  const bool is_on_map = channel == Channel::kOdom || channel == Channel::kEye;
  words.parent = told.is_far ? "far" : is_on_map ? "map" : "odom";
  return words;
}

LyingSenders::Message LyingSenders::message(Channel channel, const Words& words, bool is_rival) {
  Message made = is_ball(channel)    ? poses(channel, words, is_rival)
                 : is_robot(channel) ? joint_states(channel, words, is_rival)
                 : is_frame(channel) ? frames(channel, words)
                                     : seen(channel, words);
  made.writer = writer_of(channel, is_rival);
  return made;
}

LyingSenders::Message LyingSenders::poses(Channel channel, const Words& words, bool is_rival) {
  const std::string source = std::string(is_rival ? "rival of " : "tracker of ") + name(channel);
  PoseBatch batch{SourceName(source),
                  ++sequence_[index(channel) + (is_rival ? kChannels : 0)],
                  scene_.revision,
                  {}};
  PoseSample sample;
  const auto named = std::ranges::find(scene_.objects, name(channel), &Object::name);
  sample.object = static_cast<std::uint32_t>(named - scene_.objects.begin());
  sample.stamp_ns = words.stamp_ns;
  sample.world_from_object = as_pose(words.pose);
  sample.world_from_object.orientation.coeffs() *= words.quaternion_scale;
  sample.has_twist = words.has_velocities;
  if (sample.has_twist) sample.twist = words.twist;
  batch.samples.push_back(sample);
  Sample<clearance_msg_PoseBatch> wire = make_batch(1);
  to_wire(batch, *wire);
  const auto cdr = encoder_.encode(*wire);
  Message made;
  made.topic = intake_.topic(TopicKind::kPoses)->number;
  made.cdr.assign(cdr.begin(), cdr.end());
  return made;
}

LyingSenders::Message LyingSenders::joint_states(Channel channel, const Words& words,
                                                 bool is_rival) {
  const std::string robot = name(channel);
  Message made;
  if (by_ros_[channel == Channel::kArm ? 0 : 1]) {
    JointStateText state;
    for (std::size_t i = 0; i < words.told_joints; ++i) {
      state.name.push_back(kJointNames[i % kJoints]);
      state.position.push_back(static_cast<double>(words.joints[i].position));
      if (words.has_velocities)
        state.velocity.push_back(static_cast<double>(words.joints[i].velocity));
    }
    if (words.has_too_few) state.position.pop_back();
    const std::string topic_name = "/" + robot + "/joint_states";
    made.topic = topic(topic_name, "sensor_msgs/msg/JointState");
    made.cdr = joint_state(words.stamp_ns, words.stamp_ns, state, topic_name).cdr;
    return made;
  }
  PoseBatch batch{SourceName((is_rival ? "rival of " : "driver of ") + robot),
                  ++sequence_[index(channel) + (is_rival ? kChannels : 0)],
                  0,
                  {}};
  for (std::size_t i = 0; i < words.told_joints; ++i) {
    const auto named = std::ranges::find(scene_.variables, robot + "_" + kJointNames[i % kJoints],
                                         &JointVariable::name);
    JointSample sample;
    sample.variable = static_cast<std::uint32_t>(named - scene_.variables.begin());
    sample.stamp_ns = words.stamp_ns;
    sample.position = static_cast<double>(words.joints[i].position);
    sample.velocity = static_cast<double>(words.joints[i].velocity);
    sample.has_velocity = words.has_velocities;
    batch.joints.push_back(sample);
  }
  if (words.has_too_few) batch.joints.pop_back();
  const auto wire = make_joint_states(batch, scene_);
  const auto cdr = encoder_.encode(*wire);
  made.topic = intake_.topic(TopicKind::kJointStates)->number;
  made.cdr.assign(cdr.begin(), cdr.end());
  return made;
}

LyingSenders::Message LyingSenders::frames(Channel channel, const Words& words) {
  const std::string topic_name = words.is_static ? "/tf_static" : "/tf";
  Pose pose = as_pose(words.pose);
  pose.orientation.coeffs() *= words.quaternion_scale;
  Message made;
  made.topic = topic(topic_name, kTfType);
  made.cdr = transforms(words.stamp_ns, words.stamp_ns,
                        {frame_text(words.parent, child_of(channel), pose)}, topic_name)
                 .cdr;
  return made;
}

LyingSenders::Message LyingSenders::clock(std::int64_t t) {
  RosCdr cdr;
  cdr.number(static_cast<std::int32_t>((start_ns_ + t) / kSecond))
      .number(static_cast<std::uint32_t>((start_ns_ + t) % kSecond));
  return {t, topic("/clock", "rosgraph_msgs/msg/Clock"), kSimulation,
          start_ns_ + sending_.machine_time(t), cdr.bytes()};
}

std::uint32_t LyingSenders::topic(const std::string& name, const std::string& type) {
  const auto found = intake_.topic({name, type});
  EXPECT_TRUE(found) << name;
  return found ? found->number : 0;
}

void LyingSenders::post(Message message, std::int64_t t, const Told& told, Channel channel) {
  const std::size_t i = index(channel);
  message.sent_ns = start_ns_ + sending_.machine_time(t);
  const auto delay = static_cast<std::int64_t>(
      random_.unit() * static_cast<double>(std::max(sending_.jitter, told.longest_delay)));
  message.due = std::max(t + delay, told.held_until);
  if (told.longest_delay == 0) message.due = last_due_[i] = std::max(message.due, last_due_[i]);
  if (told.is_repeated) {
    for (const std::int64_t later : {std::int64_t{0}, 3 * kMs, 40 * kMs}) {
      Message again = message;
      again.due += later;
      in_flight_.emplace(again.due, std::move(again));
    }
  }
  in_flight_.emplace(message.due, std::move(message));
}

void LyingSenders::deliver(std::int64_t t) {
  const std::int64_t machine = sending_.machine_time(t);
  const Now now{.realtime_ns = start_ns_ + machine, .monotonic_ns = kSecond + machine};
  const auto waits = in_flight_.upper_bound(t);
  for (auto each = in_flight_.begin(); each != waits; ++each) {
    const Message& sent = each->second;
    EXPECT_TRUE(intake_.take(
        {.topic = sent.topic, .cdr = sent.cdr, .sent_ns = sent.sent_ns, .writer = sent.writer},
        now));
  }
  in_flight_.erase(in_flight_.begin(), waits);
  intake_.settle(now);
  static_cast<void>(intake_.take_news());
}

}  // namespace clearance::test::lies
