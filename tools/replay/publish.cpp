#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <variant>

#include "config/text/sentences.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/recording/input_log.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tools/replay/arguments.hpp"
#include "tools/shared/progress_bar.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

std::int64_t monotonic_ns() { return SystemClock().monotonic_ns(); }

// What discovery needs: 2 to 12 ms, or longer on a busy machine.
constexpr std::int64_t kSettleNs = 300 * kMillisecond;

// The writers of a recording's channels, each made when its channel first occurs.
class Writers {
 public:
  explicit Writers(Participant& participant) : participant_(participant) {}

  dds_entity_t of(const RecordedMessage& message) {
    const auto [writer, added] = writers_.try_emplace(message.channel->topic, 0);
    if (added) writer->second = participant_.writer(message.kind, message.channel->topic);
    return writer->second;
  }
  // The number of writers that have a reader.
  [[nodiscard]] std::size_t heard() const {
    return static_cast<std::size_t>(std::ranges::count_if(writers_, [](const auto& writer) {
      dds_publication_matched_status_t status{};
      return dds_get_publication_matched_status(writer.second, &status) == DDS_RETCODE_OK &&
             status.current_count > 0;
    }));
  }
  [[nodiscard]] std::size_t count() const { return writers_.size(); }
  // A reader may discover the writer later than the writer discovers it. What was sent until then
  // does not reach it.
  void let_first_arrive(dds_entity_t writer) {
    if (begun_.insert(writer).second) dds_wait_for_acks(writer, kSettleNs);
  }
  void wait_until_delivered() const {
    for (const auto& [topic, writer] : writers_) dds_wait_for_acks(writer, DDS_SECS(1));
  }

 private:
  Participant& participant_;
  std::map<std::string, dds_entity_t> writers_;
  std::set<dds_entity_t> begun_;  // have written
};

// Maps log times to the times at which a replay at some rate publishes, CLOCK_REALTIME.
struct Schedule {
  double rate = 1.0;
  std::int64_t began_log_ns = 0, began_ns = 0;

  [[nodiscard]] std::int64_t of(std::int64_t log_ns) const noexcept {
    return began_ns + std::llround(static_cast<double>(log_ns - began_log_ns) / rate);
  }
};

// Decodes and writes one message, under its original source stamp or under that of the schedule.
class Sender {
 public:
  Sender(const Participant& participant, bool restamp)
      : participant_(participant), restamp_(restamp) {}
  void begin(const Schedule& schedule) { schedule_ = schedule; }

  // False: the bytes are not what the channel says.
  bool send(const RecordedMessage& message, dds_entity_t writer) {
    switch (message.kind) {
      case TopicKind::kCatalogue:
        return send(message, writer, catalogue_);
      case TopicKind::kPoses:
        return send(message, writer, poses_);
      case TopicKind::kJointStates:
        return send(message, writer, joints_);
      case TopicKind::kDistances:
        return send(message, writer, distances_);
      case TopicKind::kZones:
        return send(message, writer, zone_);
      case TopicKind::kHealth:
        return send(message, writer, health_);
      case TopicKind::kSeparation:
        return send(message, writer, separation_);
      case TopicKind::kGradients:
        return send(message, writer, gradients_);
      case TopicKind::kCommands:
      case TopicKind::kCommandResults:
      case TopicKind::kQuestions:
      case TopicKind::kAnswers:
      case TopicKind::kPartnerTicks:
      case TopicKind::kPartnerStates:
      case TopicKind::kPartnerFrames:
      case TopicKind::kPartnerScenes:
        break;  // recordings do not have them
    }
    return false;
  }

 private:
  template <class T>
  bool send(const RecordedMessage& message, dds_entity_t writer, Sample<T>& sample) {
    if (!decoder_.decode(message.cdr, sample)) return false;
    std::int64_t stamp_ns = message.publish_ns;
    if constexpr (std::is_same_v<T, clearance_msg_PoseBatch> ||
                  std::is_same_v<T, clearance_msg_JointStates>) {
      if (restamp_) stamp_ns = moved_to_now(message, *sample);
    }
    // What was recorded for one domain goes out in another one. Its time of publishing stays.
    if constexpr (requires { sample->delivery_checksum; })
      seal(*sample, participant_.address(message.channel->topic));
    check_dds(dds_write_ts(writer, &*sample, std::max<std::int64_t>(stamp_ns, 0)),
              fmt::format("writing to {}", message.channel->topic));
    return true;
  }

  // Stamps are moved by the schedule rather than set to the moment of sending, so that their
  // intervals stay as even as in the recording.
  std::int64_t moved_to_now(const RecordedMessage& message, clearance_msg_PoseBatch& batch) const {
    for (std::uint32_t i = 0; i < batch.poses._length; ++i) {
      clearance_msg_ObjectPose& pose = batch.poses._buffer[i];
      pose.stamp_ns = schedule_.of(pose.stamp_ns);
      for (clearance_msg_Vector3* v : {&pose.linear, &pose.angular}) {
        *v = {v->x * schedule_.rate, v->y * schedule_.rate, v->z * schedule_.rate};
      }
    }
    return schedule_.of(message.publish_ns);
  }

  std::int64_t moved_to_now(const RecordedMessage& message,
                            clearance_msg_JointStates& states) const {
    states.stamp_ns = schedule_.of(states.stamp_ns);
    for (std::uint32_t i = 0; i < states.velocities._length; ++i) {
      states.velocities._buffer[i] *= schedule_.rate;
    }
    return schedule_.of(message.publish_ns);
  }

  const Participant& participant_;
  bool restamp_;
  Schedule schedule_;
  CdrDecoder decoder_;
  Sample<clearance_msg_Catalogue> catalogue_;
  Sample<clearance_msg_PoseBatch> poses_;
  Sample<clearance_msg_JointStates> joints_;
  Sample<clearance_msg_Distances> distances_;
  Sample<clearance_msg_ZoneState> zone_;
  Sample<clearance_msg_Health> health_;
  Sample<clearance_msg_Separation> separation_;
  Sample<clearance_msg_Gradients> gradients_;
};

// Sleeps until a time, but reacts to a signal within 20 ms. False: a signal came.
bool wait_until(std::int64_t due_ns, StopSignal& stop) {
  constexpr std::int64_t kPatienceNs = 20 * kMillisecond;
  for (;;) {
    const std::int64_t left = due_ns - monotonic_ns();
    if (left <= kPatienceNs) break;
    if (stop.wait((left - kPatienceNs / 2) / kMillisecond)) return false;
  }
  SystemClock().sleep_until(due_ns);
  return true;
}

class Publishing {
 public:
  Publishing(const PublishArguments& arguments, const DdsOptions& dds, std::int64_t first_ns,
             StopSignal& stop)
      : arguments_(arguments),
        first_ns_(first_ns),
        stop_(stop),
        participant_(dds),
        writers_(participant_),
        sender_(participant_, arguments.restamp) {}

  int run();

 private:
  [[nodiscard]] McapWindow window() const;
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    return {arguments_.span.recordings.begin(), arguments_.span.recordings.end()};
  }
  bool wanted(const RecordedMessage& message) {
    topics_.insert(message.channel->topic);
    return arguments_.only.empty() ||
           std::ranges::find(arguments_.only, message.channel->topic) != arguments_.only.end();
  }
  bool prepare();
  bool publish(const RecordedMessage& message);
  int finish(const RecordingReader& reader);

  const PublishArguments& arguments_;
  std::int64_t first_ns_;
  StopSignal& stop_;
  Participant participant_;
  Writers writers_;
  Sender sender_;
  ProgressBar bar_;
  std::int64_t began_ns_ = 0;       // monotonic
  std::int64_t began_log_ns_ = -1;  // log time of the first message published
  std::int64_t shown_ns_ = 0;
  std::uint64_t published_ = 0, undecodable_ = 0;
  std::set<std::string> topics_;  // found between start and end
};

McapWindow Publishing::window() const {
  const auto at = [this](double seconds) {
    return static_cast<std::uint64_t>(first_ns_ + std::llround(seconds * 1e9));
  };
  McapWindow window;
  if (arguments_.span.start_s > 0.0) window.start_ns = at(arguments_.span.start_s);
  if (arguments_.span.end_s < 1e9) window.end_ns = at(arguments_.span.end_s);
  return window;
}

// Makes the writers of the channels at the beginning, and gives readers a moment to discover them.
bool Publishing::prepare() {
  RecordingReader reader(files(), window());
  RecordedMessage message;
  for (int i = 0; i < 1000 && reader.next(message); ++i) {
    if (wanted(message)) writers_.of(message);
  }
  // As soon as a topic has a reader, the others get a moment more.
  std::int64_t until = monotonic_ns() + std::llround(arguments_.wait_s * 1e9);
  for (std::size_t heard = 0; heard < writers_.count() && monotonic_ns() < until;) {
    if (writers_.heard() > heard) until = monotonic_ns() + kSettleNs;
    heard = writers_.heard();
    if (stop_.wait(5)) return false;
  }
  if (writers_.heard() == 0) {
    print(stderr, "clearance-replay: no reader on {}; publishing all the same\n",
          participant_.where());
  }
  return true;
}

bool Publishing::publish(const RecordedMessage& message) {
  if (began_log_ns_ < 0) {
    began_log_ns_ = message.log_ns;
    began_ns_ = monotonic_ns();
    sender_.begin({arguments_.rate, began_log_ns_, dds_time()});
  }
  const auto after = static_cast<double>(message.log_ns - began_log_ns_) / arguments_.rate;
  if (!wait_until(began_ns_ + static_cast<std::int64_t>(after), stop_)) return false;
  const dds_entity_t writer = writers_.of(message);
  if (sender_.send(message, writer)) {
    writers_.let_first_arrive(writer);
    ++published_;
  } else {
    ++undecodable_;
  }
  return published_ % 64 != 0 || !stop_.wait(0);
}

int Publishing::run() {
  if (!prepare()) return kOk;
  RecordingReader reader(files(), window());
  RecordedMessage message;
  while (reader.next(message)) {
    if (!wanted(message)) continue;
    if (!publish(message)) break;
    if (monotonic_ns() - shown_ns_ < 100 * kMillisecond) continue;
    shown_ns_ = monotonic_ns();
    bar_.show(reader.progress(),
              fmt::format("{:.1f} s, {}", static_cast<double>(message.log_ns - first_ns_) * 1e-9,
                          counted(published_, "message")));
  }
  return finish(reader);
}

int Publishing::finish(const RecordingReader& reader) {
  writers_.wait_until_delivered();
  bar_.finish();
  const double took_s =
      began_log_ns_ < 0 ? 0.0 : static_cast<double>(monotonic_ns() - began_ns_) * 1e-9;
  print(stdout, "{} published in {:.3f} s on {}\n", counted(published_, "message"), took_s,
        participant_.where());
  if (undecodable_ > 0) {
    print(stderr, "clearance-replay: {} could not be decoded as the channel says\n",
          counted(undecodable_, "message"));
  }
  if (published_ == 0 && !stop_.wait(0)) {
    std::string met;
    for (const std::string& topic : topics_) met += (met.empty() ? "" : ", ") + topic;
    print(stderr,
          "clearance-replay: no message of these topics lies between the start and the end; found "
          "there: {}\n",
          met.empty() ? "none at all" : met);
    return kFailed;
  }
  if (!reader.error().empty()) {
    print(stderr, "clearance-replay: {}\n", reader.error());
    return reader.readable() ? kIncomplete : kFailed;
  }
  return kOk;
}

}  // namespace

int publish_recording(const PublishArguments& arguments, StopSignal& stop) {
  if (is_input_log(arguments.span.recording())) {
    print(
        stderr,
        "clearance-replay: {} holds no topics of Clearance; 'clearance-replay check' replays it as "
        "it is, and clearance-record --from-bag (or --from-csv) makes a recording of it\n",
        arguments.span.recording());
    return kFailed;
  }
  const RecordingOutline found = outline(arguments.span.recording());
  if (!found.error.empty()) {
    print(stderr, "clearance-replay: {}\n", found.error);
    return kFailed;
  }
  const auto cell = cell_of_topics(arguments.cell);
  if (!cell) return kBadCell;
  use_precise_timers();
  return Publishing(arguments, arguments.dds.resolve(*cell), found.first_ns, stop).run();
}

}  // namespace clearance
