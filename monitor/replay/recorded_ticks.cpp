// Reads ahead of a tick, since topics that were recorded over DDS overtake each other.
#include "monitor/replay/recorded_ticks.hpp"

#include <algorithm>

namespace clearance {
namespace {

// By this much log time a message may stand behind the report of its tick.
constexpr std::int64_t kTicksReadAheadNs = 2'000'000'000;

// Batches that no tick has used after this time are forgotten.
constexpr std::int64_t kUnusedNs = 10'000'000'000;
constexpr std::uint64_t kTicksBetweenForgetting = 1024;

// Only names; every index of a pair is valid.
Scene scene_of(const clearance_msg_Catalogue& catalogue) {
  Scene scene;
  scene.revision = catalogue.scene_revision;
  for (std::uint32_t i = 0; i < catalogue.objects._length; ++i)
    scene.objects.emplace_back().name = catalogue.objects._buffer[i].name;
  for (std::uint32_t i = 0; i < catalogue.pairs._length; ++i) {
    const clearance_msg_CataloguePair& pair = catalogue.pairs._buffer[i];
    if (std::max(pair.object_a, pair.object_b) >= scene.objects.size()) break;
    ObjectPair& named = scene.pairs.emplace_back();
    named.first = pair.object_a;
    named.second = pair.object_b;
  }
  for (std::uint32_t i = 0; i < catalogue.zones._length; ++i)
    scene.zones.emplace_back().name = catalogue.zones._buffer[i].name;
  for (std::uint32_t i = 0; i < catalogue.contacts._length; ++i)
    scene.contacts.emplace_back().name = catalogue.contacts._buffer[i].name;
  return scene;
}

}  // namespace

const RecordedTick* RecordedTicks::front() {
  for (;;) {
    // Latched zone states of a recording that began later precede its first report. Reports come in
    // order, so a tick before one with a report gets none.
    const auto reported = std::ranges::find_if(
        ticks_, [](const auto& tick) { return tick.second.report.has_value(); });
    if (reported != ticks_.end() || ended_) {
      while (ticks_.begin() != reported) pop();
    }
    if (!ticks_.empty() && ticks_.begin()->second.report) {
      const RecordedTick& tick = ticks_.begin()->second;
      if (ended_ || read_to_ns_ > tick.log_ns + kTicksReadAheadNs) {
        for (const clearance_msg_ZoneState& state : tick.zones) zones_[state.zone] = state;
        return &tick;
      }
    }
    if (ended_) return nullptr;
    ended_ = !read_one();
  }
}

void RecordedTicks::pop() {
  const RecordedTick& tick = ticks_.begin()->second;
  for (const clearance_msg_ZoneState& state : tick.zones) zones_[state.zone] = state;
  if (tick.report) {
    const auto& uses = (*tick.report)->sources;
    for (std::uint32_t i = 0; i < uses._length; ++i) {
      const std::string source = uses._buffer[i].source;
      batches_.erase(batches_.lower_bound({source, 0}),
                     batches_.upper_bound({source, uses._buffer[i].sequence_number}));
    }
  }
  ticks_.erase(ticks_.begin());
  if (++removed_ % kTicksBetweenForgetting == 0) {
    std::erase_if(batches_, [this](const auto& batch) {
      return batch.second.log_ns + kUnusedNs < read_to_ns_;
    });
  }
}

const clearance_msg_ZoneState* RecordedTicks::zone(std::uint32_t zone) const {
  const auto known = zones_.find(zone);
  return known == zones_.end() ? nullptr : &known->second;
}

const Scene& RecordedTicks::names(std::uint64_t revision) { return names_[revision]; }

std::string RecordedTicks::error() const {
  if (!refusal_.empty()) return refusal_;
  return reader_.readable() ? std::string() : reader_.error();
}

std::string RecordedTicks::damage() const {
  return reader_.readable() ? reader_.error() : std::string();
}

bool RecordedTicks::read_one() {
  RecordedMessage message;
  if (!refusal_.empty() || !reader_.next(message)) return false;
  read_to_ns_ = message.log_ns;
  if (message.kind == TopicKind::kDistances) add_report(message);
  if (message.kind == TopicKind::kPoses) add_batch<clearance_msg_PoseBatch>(message);
  if (message.kind == TopicKind::kJointStates) add_batch<clearance_msg_JointStates>(message);
  if (message.kind == TopicKind::kSeparation) {
    Sample<clearance_msg_Separation> separation;
    if (decoder_.decode(message.cdr, separation))
      tick_of(*separation).separation = std::move(separation);
  }
  if (message.kind == TopicKind::kGradients) {
    Sample<clearance_msg_Gradients> gradients;
    if (decoder_.decode(message.cdr, gradients))
      tick_of(*gradients).gradients = std::move(gradients);
  }
  if (message.kind == TopicKind::kZones) {
    Sample<clearance_msg_ZoneState> zone;
    if (decoder_.decode(message.cdr, zone)) tick_of(*zone).zones.push_back(*zone);
  }
  if (message.kind == TopicKind::kCatalogue) {
    Sample<clearance_msg_Catalogue> catalogue;
    if (decoder_.decode(message.cdr, catalogue))
      names_[catalogue->scene_revision] = scene_of(*catalogue);
  }
  return true;
}

void RecordedTicks::add_report(const RecordedMessage& message) {
  Sample<clearance_msg_Distances> report;
  if (!decoder_.decode(message.cdr, report)) return;
  if (daemon_.value_or(report->daemon) != report->daemon) {
    refusal_ = "reports of more than one daemon are in it; expected a recording of one run";
    return;
  }
  daemon_ = report->daemon;
  RecordedTick& tick = tick_of(*report);
  tick.log_ns = message.log_ns;
  tick.report = std::move(report);
}

template <class Message>
void RecordedTicks::add_batch(const RecordedMessage& message) {
  Sample<Message> batch;
  if (!decoder_.decode(message.cdr, batch)) return;
  sources_.insert(batch->source);
  if (batch->sequence_number == 0) return;
  batches_[{batch->source, batch->sequence_number}] = {message.log_ns,
                                                       {message.cdr.begin(), message.cdr.end()}};
}

}  // namespace clearance
