#include "monitor/replay/recorded_ticks.hpp"

#include <algorithm>

namespace clearance {
namespace {

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

RecordedTicks::RecordedTicks(const std::filesystem::path& file)
    : run_({file}, {}, [this](const RecordedMessage& message) { use(message); }) {}

const RecordedTick* RecordedTicks::front() {
  if (front_) return &*front_;
  if (!refusal_.empty()) return nullptr;
  const bool has_next = run_.next();
  const clearance_msg_Distances& report = run_.report();
  if (run_.of_others() > 0 || (has_next && daemon_.value_or(report.daemon) != report.daemon))
    refusal_ = "reports of more than one daemon are in it; expected a recording of one run";
  if (!has_next || !refusal_.empty()) return nullptr;
  daemon_ = report.daemon;
  while (run_.read_ahead()) {
  }
  const std::vector<clearance_msg_ZoneState>& zones = run_.zones();
  for (; zones_taken_ < zones.size() && zones[zones_taken_].now_ns <= report.now_ns; ++zones_taken_)
    zones_[zones[zones_taken_].zone] = zones[zones_taken_];
  return &front_.emplace(RecordedTick{report, run_.separation(), run_.gradients()});
}

void RecordedTicks::pop() {
  const auto& uses = front_->report.sources;
  for (std::uint32_t i = 0; i < uses._length; ++i) {
    const std::string source = uses._buffer[i].source;
    batches_.erase(batches_.lower_bound({source, 0}),
                   batches_.upper_bound({source, uses._buffer[i].sequence_number}));
  }
  front_.reset();
  if (++removed_ % kTicksBetweenForgetting == 0) {
    std::erase_if(batches_, [this](const auto& batch) {
      return batch.second.log_ns + kUnusedNs < run_.read_to_ns();
    });
  }
}

const clearance_msg_ZoneState* RecordedTicks::zone(std::uint32_t zone) const {
  const auto known = zones_.find(zone);
  return known == zones_.end() ? nullptr : &known->second;
}

std::string RecordedTicks::error() const {
  if (!refusal_.empty()) return refusal_;
  return run_.reader().readable() ? std::string() : run_.reader().error();
}

std::string RecordedTicks::damage() const {
  return run_.reader().readable() ? run_.reader().error() : std::string();
}

void RecordedTicks::use(const RecordedMessage& message) {
  if (message.kind == TopicKind::kPoses) add_batch<clearance_msg_PoseBatch>(message);
  if (message.kind == TopicKind::kJointStates) add_batch<clearance_msg_JointStates>(message);
  if (message.kind != TopicKind::kCatalogue) return;
  Sample<clearance_msg_Catalogue> catalogue;
  if (decoder_.decode(message.cdr, catalogue))
    names_[catalogue->scene_revision] = scene_of(*catalogue);
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
