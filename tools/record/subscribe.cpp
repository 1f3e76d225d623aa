#include <fmt/format.h>

#include <dds/dds.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "config/text/sentences.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/wire/convert.hpp"
#include "tools/record/arguments.hpp"
#include "tools/record/changed_cell.hpp"
#include "tools/record/scene_channels.hpp"
#include "tools/record/stream_gaps.hpp"

namespace clearance {
namespace {

// Two seconds at 1 kHz, in case the disk stalls.
constexpr std::int32_t kDepth = 2048;
constexpr std::size_t kMostWaiting = 8192;  // samples taken before the other topics are checked

// Readers of all topics. Their samples go into the recording byte for byte.
class Subscription {
 public:
  // `scene`: channels for 3D viewers, or null.
  Subscription(Participant& participant, const Topics& topics, RecordingWriter& writer,
               const RecordingOptions& options, SceneChannels* scene, ChangedCell& changed)
      : writer_(writer), options_(options), scene_(scene), changed_(changed) {
    for (const Topic& topic : kRecordedTopics) {
      readers_[index(topic.kind)] = participant.reader(topic.kind, topics.*topic.name, kDepth);
    }
  }

  [[nodiscard]] std::vector<dds_entity_t> readers() const {
    return {readers_.begin(), readers_.end()};
  }
  [[nodiscard]] std::uint64_t count(TopicKind kind) const { return counts_[index(kind)]; }
  [[nodiscard]] std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts_) sum += count;
    return sum;
  }
  // Samples that arrived too fast for this program or were lost in transit.
  [[nodiscard]] std::uint64_t lost() const {
    std::uint64_t sum = 0;
    for (const dds_entity_t reader : readers_) {
      dds_sample_lost_status_t status{};
      if (dds_get_sample_lost_status(reader, &status) == DDS_RETCODE_OK) sum += status.total_count;
    }
    return sum;
  }

  [[nodiscard]] std::vector<std::string> gaps() const { return gaps_.notes(); }

  // In the order of the table, so that poses stand before the reports that used them.
  void take_all() {
    for (const Topic& topic : kRecordedTopics) {
      while (taken_.size() < kMostWaiting && take_cdr(readers_[index(topic.kind)], taken_) > 0) {
      }
      // Cyclone returns waiting samples instance by instance; this restores the order of sending.
      std::ranges::stable_sort(taken_, {}, &CdrSample::source_ns);
      const std::int64_t now_ns = dds_time();
      for (const CdrSample& taken : taken_) record(topic.kind, now_ns, taken);
      taken_.clear();
    }
    changed_.poll(dds_time());
  }

 private:
  void record(TopicKind kind, std::int64_t now_ns, const CdrSample& taken) {
    const std::span<const std::byte> bytes = taken.bytes();
    ++counts_[index(kind)];
    const bool decoded = look_into(kind, bytes);
    const bool is_report = decoded && kind == TopicKind::kDistances;
    if (decoded && kind == TopicKind::kGradients && !keeps_pairs(options_, gradients_->cycle)) {
      return;
    }
    if (is_report && !keeps_pairs(options_, report_->cycle)) {
      write_without_pairs(kind, *report_, now_ns, taken.source_ns());
    } else if (decoded && kind == TopicKind::kSeparation &&
               !keeps_pairs(options_, separation_->cycle)) {
      write_without_pairs(kind, *separation_, now_ns, taken.source_ns());
    } else {
      writer_.write(kind, now_ns, taken.source_ns(), bytes);
    }
    if (scene_ == nullptr) return;
    if (kind == TopicKind::kPoses || kind == TopicKind::kJointStates) scene_->take(kind, bytes);
    if (decoded && kind == TopicKind::kDistances) scene_->take(*report_, now_ns);
  }

  template <class Message>
  void write_without_pairs(TopicKind kind, Message& message, std::int64_t now_ns,
                           std::int64_t source_ns) {
    const std::uint32_t pairs = std::exchange(message.pairs._length, 0);
    writer_.write(kind, now_ns, source_ns, message);
    message.pairs._length = pairs;
  }

  // False: the sample does not decode, or nothing needs to be known of its kind.
  bool look_into(TopicKind kind, std::span<const std::byte> bytes) {
    if (kind == TopicKind::kCatalogue && decoder_.decode(bytes, catalogue_)) {
      writer_.describe(*catalogue_);
      changed_.hear(*catalogue_);
    } else if (kind == TopicKind::kPoses && decoder_.decode(bytes, batch_)) {
      gaps_.note("batches", fmt::format("of source '{}'", batch_->source), batch_->sequence_number);
    } else if (kind == TopicKind::kJointStates && decoder_.decode(bytes, joints_)) {
      gaps_.note("batches", fmt::format("of source '{}'", joints_->source),
                 joints_->sequence_number);
    } else if (kind == TopicKind::kDistances && decoder_.decode(bytes, report_)) {
      gaps_.note("reports", "of the daemon", report_->cycle);
    } else {
      return (kind == TopicKind::kGradients && decoder_.decode(bytes, gradients_)) ||
             (kind == TopicKind::kSeparation && decoder_.decode(bytes, separation_));
    }
    return true;
  }

  RecordingWriter& writer_;
  RecordingOptions options_;
  SceneChannels* scene_;
  ChangedCell& changed_;
  std::array<dds_entity_t, kRecordedTopics.size()> readers_{};
  std::array<std::uint64_t, kRecordedTopics.size()> counts_{};
  std::vector<CdrSample> taken_;
  CdrDecoder decoder_;
  Sample<clearance_msg_Catalogue> catalogue_;
  Sample<clearance_msg_PoseBatch> batch_;
  Sample<clearance_msg_JointStates> joints_;
  Sample<clearance_msg_Distances> report_;
  Sample<clearance_msg_Gradients> gradients_;
  Sample<clearance_msg_Separation> separation_;
  StreamGaps gaps_;
};

void show(const Subscription& subscription, const RecordingWriter& writer, const char* end) {
  print(stderr, "{} poses, {} joint states, {} distances, {} zones, {} health; {:.1f} MB{}",
        subscription.count(TopicKind::kPoses), subscription.count(TopicKind::kJointStates),
        subscription.count(TopicKind::kDistances), subscription.count(TopicKind::kZones),
        subscription.count(TopicKind::kHealth), static_cast<double>(writer.bytes()) * 1e-6, end);
}

// Records until a signal comes, the time is up, or the file cannot be written.
void record_until(std::int64_t end_ns, Subscription& subscription, Participant& participant,
                  RecordingWriter& writer, SceneChannels* scene, StopSignal& stop) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  DataWait wait(participant, subscription.readers());
  std::int64_t shown_ns = dds_time();
  while (writer.ok() && !stop.wait(0) && dds_time() < end_ns) {
    wait.wait(20'000'000);  // a signal is heard within 20 ms
    subscription.take_all();
    if (writer.roll(dds_time()) && scene != nullptr) scene->write_bodies(dds_time());
    if (dds_time() - shown_ns < kSecond) continue;
    shown_ns = dds_time();
    writer.flush();
    writer.check();
    if (!terminal) continue;
    print(stderr, "\r");
    show(subscription, writer, " ");
  }
  if (terminal) print(stderr, "\n");
}

}  // namespace

int record_from_dds(const RecordArguments& arguments, const Cell* cell, StopSignal& stop) {
  Participant participant(cell == nullptr ? arguments.dds.resolve() : arguments.dds.resolve(*cell));
  const Topics topics = cell == nullptr ? Topics{} : cell->topics;
  const RecordingOptions options = arguments.recording.options(arguments.force);
  RecordingWriter writer(arguments.out, topics, options);
  // The daemon's own catalogue follows when there is a daemon; poses alone need one as well.
  if (cell != nullptr) {
    if (const std::string why = writer.attach(*cell); !why.empty()) {
      print(stderr,
            "clearance-record: the files that the cell names are not in the recording: {}. A "
            "replay needs --cell\n",
            why);
    }
    writer.catalogue(*make_catalogue(*cell), dds_time());
  }
  std::optional<SceneChannels> channels;
  if (arguments.scene && cell != nullptr) channels.emplace(cell->scene, writer, dds_time());
  SceneChannels* const drawn = channels ? &*channels : nullptr;
  ChangedCell changed(arguments.cell, cell, writer, drawn);
  Subscription subscription(participant, topics, writer, options, drawn, changed);
  const std::int64_t end_ns = arguments.seconds > 0.0
                                  ? dds_time() + static_cast<std::int64_t>(arguments.seconds * 1e9)
                                  : std::numeric_limits<std::int64_t>::max();
  record_until(end_ns, subscription, participant, writer, drawn, stop);
  if (!writer.close()) {
    print(stderr, "clearance-record: {}\n", writer.error());
    return kFailed;
  }
  print(stderr, "{}: ", arguments.out);
  show(subscription, writer, "\n");
  if (subscription.lost() > 0) {
    print(stderr, "clearance-record: lost {} before recording\n",
          counted(subscription.lost(), "sample"));
  }
  for (const std::string& gap : subscription.gaps()) {
    print(stderr, "clearance-record: {}\n", gap);
  }
  const std::uint64_t inputs =
      subscription.count(TopicKind::kPoses) + subscription.count(TopicKind::kJointStates);
  if (subscription.count(TopicKind::kDistances) > 0 && inputs == 0 &&
      writer.holds(TopicKind::kPoses)) {
    print(
        stderr,
        "clearance-record: it holds reports and nothing that they were made from, so it can be "
        "shown and not replayed. What comes from ROS 2 the daemon records: clearanced --record\n");
  }
  if (subscription.total() > 0) return kOk;
  print(stderr,
        "clearance-record: nothing was received on {}; does the daemon run there, with these topic "
        "names?\n",
        participant.where());
  return kFailed;
}

}  // namespace clearance
