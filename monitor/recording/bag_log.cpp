// Messages wait until the bag has been read further by kLogDisorderNs.
#include "monitor/recording/bag_log.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "monitor/intake/frame_decoders.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tf_tree.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {
namespace {

// The largest number of messages that wait, however close their times are.
constexpr std::size_t kMostWaiting = 1 << 16;
// 2^62 ns, a time in the year 2116.
constexpr std::int64_t kLastTimeNs = std::int64_t{1} << 62;
// Time passes step by step for so long after a message, ns: whoever is silent longer stays silent.
constexpr std::int64_t kSilenceNs = 10'000'000'000;
constexpr std::int64_t kLeastPatienceNs = 1'000'000;
constexpr std::string_view kJointStateType = "sensor_msgs/msg/JointState";

}  // namespace

BagLog::BagLog(const std::filesystem::path& path, const Cell& cell, const InputLogOptions& options)
    : cell_(&cell),
      options_(options),
      path_(path),
      bag_(open_bag(path)),
      time_(cell.ros.use_sim_time ? std::make_unique<SimulatedTime>() : nullptr),
      intake_(cell,
              {.is_log = true,
               .joint_topics = options.joint_topics,
               .use_scene = options.with_scenes
                                ? [this](moveit::RawScene message) { use(std::move(message)); }
                                : MoveItMessages::Use(),
               .use_sensor = options.with_sensors
                                 ? [this](RawSensorMessage message) { use(std::move(message)); }
                                 : UseSensorMessage(),
               .time = time_.get()},
              [this](PoseBatch& batch) {
                use(std::move(batch));
                return true;
              }),
      given_(cell.scene, options.joints) {
  error_ = given_.error();
  ended_ = !error_.empty();
}

const std::string& BagLog::error() const noexcept {
  return bag_->error().empty() ? error_ : bag_->error();
}

// Fails if the whole bag has no batch. A message with an earlier time that comes after this one is
// not put back in order.
bool BagLog::next(LoggedBatch& batch) {
  while (decoded_.empty()) {
    read_ahead();
    if (waiting_.empty()) {
      if (!given_out_ && error().empty()) error_ = nothing_of_use();
      return false;
    }
    const auto first = next_waiting();
    if (let_time_pass(first->first)) continue;
    const Message message = std::move(first->second);
    waiting_.erase(first);
    take(message);
  }
  batch = std::move(decoded_.front());
  decoded_.pop_front();
  given_out_ = given_out_ || batch.scene == nullptr;
  return true;
}

// The first message of /clock comes before all others, which are judged by it.
std::multimap<std::int64_t, BagLog::Message>::iterator BagLog::next_waiting() {
  if (topic_ != nullptr || !has_clock_) return waiting_.begin();
  return std::ranges::find_if(waiting_, [this](const auto& waiting) {
    return intake_.is_clock(*waiting.second.topic->number);
  });
}

void BagLog::change(const Cell& cell) {
  const SceneMap map = scene_map(cell_->scene, cell.scene);
  for (LoggedBatch& decoded : decoded_) pass_on(map, cell_->scene, cell.scene, decoded.batch);
  cell_ = &cell;
  intake_.change(cell);
  given_ = given_of(cell_->scene);
  for (auto& [name, topic] : topics_) choose(topic);
}

void BagLog::read_ahead() {
  BagMessage message;
  while (!ended_ && (waiting_.empty() || (read_to_ns_ < waiting_.begin()->first + kLogDisorderNs &&
                                          waiting_.size() < kMostWaiting))) {
    ended_ = !bag_->next(message);
    if (ended_) break;
    // With this clamp, sums and differences of times cannot overflow, not even for a hostile bag.
    message.log_ns = std::clamp(message.log_ns, std::int64_t{0}, kLastTimeNs);
    keep(message);
  }
}

void BagLog::keep(const BagMessage& message) {
  const auto [entry, added] = topics_.try_emplace(message.topic->name);
  Topic& topic = entry->second;
  if (added) {
    topic.of = *message.topic;
    choose(topic);
  }
  ++topic.messages;
  read_to_ns_ = std::max(read_to_ns_, message.log_ns);
  if (!topic.number) return;
  waiting_.emplace(
      message.log_ns,
      Message{&topic, message.log_ns, {message.payload.begin(), message.payload.end()}});
}

// A changed cell may use more topics, and none that was used is left out. A clock that begins late
// is not used beside the times of recording.
void BagLog::choose(Topic& topic) {
  if (topic.number || topic.of.encoding != "cdr") return;
  const auto wanted = intake_.topic({topic.of.name, topic.of.type});
  if (!wanted || (intake_.is_clock(wanted->number) && topic_ != nullptr)) return;
  topic.number = wanted->number;
  has_clock_ = has_clock_ || intake_.is_clock(wanted->number);
}

// Returns false if nothing is due before that time.
bool BagLog::let_time_pass(std::int64_t until_ns) {
  if (topic_ == nullptr) return false;
  const std::int64_t step_ns = std::max(intake_.patience_ns(), kLeastPatienceNs);
  if (step_ns >= std::min(until_ns, last_ns_ + kSilenceNs) - log_ns_) return false;
  log_ns_ += step_ns;
  settle();
  return true;
}

void BagLog::take(const Message& message) {
  topic_ = message.topic;
  last_ns_ = log_ns_ = std::max(log_ns_, message.log_ns);
  const std::int64_t clock_ns = note_time();
  intake_.take({.topic = *topic_->number, .cdr = message.payload, .sent_ns = message.log_ns},
               {.realtime_ns = log_ns_, .monotonic_ns = log_ns_});
  if (time_ && time_->clock_ns() < clock_ns && given_ns_ > 0) return end_run(clock_ns);
  settle();
  // A message that moves nothing shows that the time has passed without one that does.
  if (decoded_.empty() && given_out_) decoded_.push_back({.batch = {}, .log_ns = time_ns()});
}

// Returns the time of the clock. A recorder with the time of a clock gives all messages of one step
// the same time.
std::int64_t BagLog::note_time() {
  if (!time_) return 0;
  if (!has_clock_ && (!time_->is_known() || log_ns_ > time_->clock_ns()))
    time_->note(log_ns_, log_ns_, log_ns_);
  return time_->clock_ns();
}

void BagLog::end_run(std::int64_t clock_ns) {
  error_ = fmt::format(
      "{}: /clock goes back from {:.3f} s to {:.3f} s. That is another run of the simulation, and "
      "the messages from then on are not used",
      path_.string(), seconds(clock_ns), seconds(time_->clock_ns()));
  ended_ = true;
  waiting_.clear();
}

// Returns the time at which what has been decoded can be used. Never decreases.
std::int64_t BagLog::time_ns() noexcept {
  const std::int64_t now_ns = time_ ? time_->now_ns(log_ns_) : log_ns_;
  given_ns_ = std::max(given_ns_, has_clock_ ? now_ns : std::max(now_ns, log_ns_));
  return given_ns_;
}

void BagLog::settle() {
  intake_.settle({.realtime_ns = log_ns_, .monotonic_ns = log_ns_});
  for (News& news : intake_.take_news()) {
    const bool is_unused =
        news.code == lines::kTopicNotUsed.code && news.level == lines::kTopicNotUsed.level;
    const bool is_told =
        is_unused || news.code == lines::kSlowInput.code ||
        news.code == lines::kBodiesSilent.code || news.code == lines::kTooManyBodies.code ||
        news.code == lines::kFrameRefused.code || news.code == lines::kFrameMissing.code;
    if (is_told && std::ranges::find(told_, news.text) == told_.end())
      told_.push_back(std::move(news.text));
  }
}

// A changed cell may lack some of the joints.
GivenJoints BagLog::given_of(const Scene& scene) const {
  std::map<std::string, double> there = options_.joints;
  const std::vector<std::string> names = joint_names(scene);
  std::erase_if(there, [&](const auto& joint) {
    return std::ranges::find(names, joint.first) == names.end();
  });
  return {scene, there};
}

// Messages do not move joints whose positions are given. Batches are numbered in the order of use.
void BagLog::use(PoseBatch batch) {
  std::erase_if(batch.joints, [this](const JointSample& sample) {
    const std::string& name = cell_->scene.variables[sample.variable].name;
    heard_.insert(name);
    return options_.joints.contains(name);
  });
  if (batch.empty()) {
    ++topic_->empty;
    return;
  }
  const std::int64_t now_ns = time_ns();
  const auto give_out = [this, now_ns](PoseBatch decoded) {
    decoded.sequence_number = ++sequence_[std::string(decoded.source.view())];
    decoded.scene_revision = cell_->scene.revision;
    decoded_.push_back({std::move(decoded), now_ns});
  };
  give_out(std::move(batch));
  if (!given_.empty()) give_out(given_.at(now_ns));
}

void BagLog::use(moveit::RawScene message) {
  if (time_ && !time_->is_known()) return;
  decoded_.push_back({.batch = {},
                      .log_ns = time_ns(),
                      .scene = std::make_shared<const moveit::RawScene>(std::move(message))});
}

void BagLog::use(RawSensorMessage message) {
  if (time_ && !time_->is_known()) return;
  if (time_) lead(message);
  decoded_.push_back({.batch = {},
                      .log_ns = time_ns(),
                      .sensor = std::make_shared<const RawSensorMessage>(std::move(message))});
}

// The stamps of pictures, and of transforms that place a camera.
void BagLog::lead(const RawSensorMessage& message) {
  Sample<tf2_msgs_msg_dds__TFMessage_> placed;
  if (message.type == RawSensorMessage::Type::kTransforms &&
      decoder_.decode(message.cdr, placed, message.bytes)) {
    for (std::uint32_t i = 0; i < placed->transforms._length; ++i)
      time_->lead(StampCheck::time_of(stamp_ns(placed->transforms._buffer[i].header),
                                      message.sent_ns, cell_->ros.stamps, OtherClock::kReplaced));
  }
  const FrameDecoder* const decoder = frame_decoder(message.type);
  for (const Sensor& sensor : cell_->scene.sensors) {
    if (decoder == nullptr || sensor.kind != decoder->kind || sensor.topic != message.topic ||
        sensor.stamps == RosStamps::kSent)
      continue;
    if (const auto cloud = decoder->decode(message, sensor, decoder_)) time_->lead(cloud->stamp_ns);
  }
}

template <class IsListed>
std::vector<std::string> BagLog::topics(const IsListed& is_listed) const {
  std::vector<std::string> there;
  for (const auto& [name, topic] : topics_) {
    if (is_listed(topic.of.type))
      there.push_back(
          fmt::format("{} ({}, {})", name, topic.of.type, counted(topic.messages, "message")));
  }
  return there;
}

std::vector<std::string> BagLog::topics_of(SensorKind kind) const {
  return topics([kind](const std::string& type) { return is_frame_type(kind, type); });
}

// Lists the topics that the bag has instead, so that a user can choose one.
std::string BagLog::nothing_of_use() const {
  const std::vector<std::string> there = topics([](const std::string&) { return true; });
  const auto& joints = intake_.joint_states().unknown_names();
  if (!joints.empty()) {
    return fmt::format(
        "{} has nothing that moves this cell: its joint states are of joints that the cell's "
        "robots "
        "do not have: {}; theirs are {}",
        path_.string(), fmt::join(joints, ", "), fmt::join(joint_names(cell_->scene), ", "));
  }
  return fmt::format(
      "{} has nothing that moves this cell: no joint states of its robots and no transforms to its "
      "objects. Expected a topic joint_states of type {} with its joints' names, or one that "
      "--joint-topic names; there are {}",
      path_.string(), kJointStateType,
      there.empty() ? std::string("no messages") : fmt::format("{}", fmt::join(there, ", ")));
}

std::vector<std::string> BagLog::notes() const {
  std::vector<std::string> notes;
  if (!given_out_) return notes;  // error() tells why
  for (const auto& [name, topic] : topics_) {
    if (!topic.number) continue;
    const auto note = [&, &topic_name = name](std::uint64_t count, const std::string& what) {
      if (count > 0)
        notes.push_back(fmt::format("{} of {} {}", counted(count, "message"), topic_name, what));
    };
    const TopicCounts& counts = intake_.counts(*topic.number);
    note(counts.undecodable, "did not decode as " + topic.of.type + ": left out");
    note(topic.empty, "had no position of a joint of this cell");
    note(counts.unstamped, "had no stamp: the time of recording is used");
    note(counts.of_another_clock,
         fmt::format("had a stamp of another clock ({:+.1f} s): the time of recording is used",
                     static_cast<double>(counts.clock_difference_ns) * 1e-9));
  }
  notes.insert(notes.end(), told_.begin(), told_.end());
  for (const std::string& joint : intake_.joint_states().unknown_names()) {
    notes.push_back(fmt::format("joint '{}' of the bag is not in the cell: left out{}", joint,
                                did_you_mean(joint, joint_names(cell_->scene))));
  }
  note_unheard(cell_->scene, heard_, options_.joints, notes);
  for (const std::string& world : intake_.transforms().worlds()) {
    notes.push_back(fmt::format("frame '{}' is taken to be the cell's world", world));
  }
  return notes;
}

}  // namespace clearance
