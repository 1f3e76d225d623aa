#include "monitor/intake/intake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "monitor/inputs/source_numbers.hpp"
#include "monitor/intake/own_batches.hpp"
#include "monitor/intake/ros_clock.hpp"
#include "monitor/intake/stated_stops.hpp"
#include "monitor/intake/tracked_bodies.hpp"

namespace clearance {

Intake::Intake(const Cell& cell, IntakeOptions options, Use use)
    : scene_(&cell.scene),
      hears_moveit_(options.use_scene && cell.ros.moveit.any()),
      hears_sensors_(options.use_sensor && !cell.scene.sensors.empty()),
      topics_(&cell.topics),
      options_(std::move(options)),
      use_(std::move(use)),
      sources_(named_sources(cell.scene)),
      slow_(cell.scene) {
  if (options_.only_sensors) {
    add<SensorMessages>(cell, options_.use_sensor, *this);
    return;
  }
  const RosJointStatesOptions joint_states{
      .topics = options_.joint_topics,
      .other_clock = options_.is_log ? OtherClock::kReplaced : OtherClock::kTold,
      .most_joints = options_.most_joints};
  const auto from = options_.is_log ? TransformsFrom::kLog : TransformsFrom::kPublishers;
  // A row for every kind of input.
  add<RosClock>(options_.time, *this);
  add<OwnPoses>(cell.scene, topics_->poses, options_.most_samples, *this);
  add<OwnJointStates>(cell.scene, topics_->joint_states, options_.most_joints, *this);
  const StatedStops* const stops = add<StatedStops>(cell.scene, *this);
  joint_states_ = add<RosJointStates>(cell.scene, joint_states, *stops, *this);
  transforms_ = add<RosTransforms>(cell, from, *this, options_.use_sensor);
  add<MoveItMessages>(cell, options_.use_scene, options_.is_log, *this);
  add<TrackedBodies>(cell, options_.use_scene, *this);
  add<SensorMessages>(cell, options_.use_sensor, *this);
}

void Intake::change(const Cell& cell) {
  former_revisions_.push_back(scene_->revision);
  scene_ = &cell.scene;
  topics_ = &cell.topics;
  sources_.change_named(named_sources(cell.scene));
  slow_ = SlowInputs(cell.scene);
  for (const std::unique_ptr<Decoder>& decoder : decoders_) decoder->change(cell);
}

template <class Kind, class... Arguments>
const Kind* Intake::add(Arguments&&... arguments) {
  auto decoder = std::make_unique<Kind>(std::forward<Arguments>(arguments)...);
  const Kind* const added = decoder.get();
  decoders_.push_back(std::move(decoder));
  return added;
}

std::optional<Intake::Topic> Intake::topic(const TopicName& name) {
  const auto known = numbers_.find({name.name, name.type});
  if (known != numbers_.end()) {
    return Topic{known->second, routes_[known->second].ends.front().wanted.delivery};
  }
  Route route;
  for (const std::unique_ptr<Decoder>& decoder : decoders_) {
    if (const auto wanted = decoder->wants(name)) route.ends.push_back({decoder.get(), *wanted});
  }
  if (route.ends.empty()) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(routes_.size());
  numbers_.emplace(std::pair(name.name, name.type), number);
  routes_.push_back(std::move(route));
  return Topic{number, routes_.back().ends.front().wanted.delivery};
}

std::optional<Intake::Topic> Intake::topic(TopicKind kind) {
  const clearance::Topic& row = clearance::topic(kind);
  return topic({topics_->*row.name, row.type->m_typename});
}

std::vector<NamedTopic> Intake::named() const {
  std::vector<NamedTopic> named;
  for (const std::unique_ptr<Decoder>& decoder : decoders_)
    std::ranges::move(decoder->named(), std::back_inserter(named));
  return named;
}

bool Intake::is_clock(std::uint32_t topic) const {
  return routes_[topic].ends.front().wanted.delivery == &kRosClock;
}

bool Intake::take(const RawMessage& message, const Now& now) {
  monotonic_ns_ = now.monotonic_ns;
  Route& route = routes_[message.topic];
  ++route.counts.messages;
  RawMessage timed = message;
  if (options_.time != nullptr && !is_clock(message.topic))
    timed.sent_ns = options_.time->at(message.sent_ns);
  bool decodes = true;
  for (const Route::End& end : route.ends) {
    decodes =
        end.decoder->decode(end.wanted.port, timed, in_its_time(now), route.counts) && decodes;
  }
  if (!decodes) ++route.counts.undecodable;
  return decodes;
}

void Intake::settle(const Now& now) {
  monotonic_ns_ = now.monotonic_ns;
  for (const std::unique_ptr<Decoder>& decoder : decoders_) decoder->settle(in_its_time(now));
}

Now Intake::in_its_time(const Now& now) const noexcept {
  if (options_.time == nullptr) return now;
  return {.realtime_ns = options_.time->now_ns(now.monotonic_ns), .monotonic_ns = now.monotonic_ns};
}

std::int64_t Intake::patience_ns() const {
  std::int64_t patience = std::numeric_limits<std::int64_t>::max();
  for (const std::unique_ptr<Decoder>& decoder : decoders_)
    patience = std::min(patience, decoder->patience_ns());
  return patience;
}

void Intake::keep(std::vector<std::uint64_t> writers) {
  writers.push_back(RosTransforms::kWriter);
  std::ranges::sort(writers);
  for (const std::unique_ptr<Decoder>& decoder : decoders_) decoder->keep(writers);
  sources_.keep(writers);
}

std::vector<News> Intake::take_news() { return std::exchange(news_, {}); }

// In the daemon, a batch that was decoded by names has the ids of this cell. Before the first
// message of a simulation's clock, no batch can be judged.
void Intake::give(PoseBatch& batch, std::uint64_t writer, std::size_t cut) {
  if (options_.time != nullptr && !options_.time->is_known()) return;
  const bool is_by_name = !batch.joints.empty() || writer == RosTransforms::kWriter;
  if (options_.admits_sources && is_by_name) batch.scene_revision = scene_->revision;
  const bool is_ours = made_for(batch, scene_->revision);
  if (!options_.admits_sources) {
    if (is_ours) slow_.note(batch, *this);
    lead(batch);
    use_(batch);
    return;
  }
  SourceTally* const tally = admit(batch, writer, batch.size() + cut);
  if (tally == nullptr) return;
  if (is_ours) slow_.note(batch, *this);
  const bool is_former =
      std::ranges::find(former_revisions_, batch.scene_revision) != former_revisions_.end();
  if (!is_ours && !is_former && !std::exchange(tally->warned_of_revision, true)) {
    tell(News(lines::kOtherRevision, tally->source.view(), batch.scene_revision, scene_->revision));
  }
  lead(batch);
  if (!use_(batch)) {
    ++tally->lost;
    return;
  }
  tally->cut_poses += cut;
  ++tally->batches;
}

void Intake::lead(const PoseBatch& batch) noexcept {
  if (options_.time == nullptr) return;
  for (const PoseSample& sample : batch.samples) options_.time->lead(sample.stamp_ns);
  for (const JointSample& sample : batch.joints) options_.time->lead(sample.stamp_ns);
}

// Counts the batches that are missing before this one, too.
SourceTally* Intake::admit(PoseBatch& batch, std::uint64_t writer, std::size_t size) {
  Admission admission = sources_.admit(batch.source, writer, size, monotonic_ns_);
  tell_of(admission, batch, writer);
  if (admission.tally == nullptr && admission.cause == SourceRefusal::kOtherWriter) {
    batch.source = sources_.name_for(batch.source, writer, monotonic_ns_);
    admission = sources_.admit(batch.source, writer, size, monotonic_ns_);
    tell_of(admission, batch, writer);
  }
  if (admission.tally == nullptr) return nullptr;
  admission.tally->note_sequence(batch.sequence_number);
  admission.tally->last_ns = monotonic_ns_;
  return admission.tally;
}

std::string Intake::why_refused(const Admission& admission, const SourceName& source) const {
  switch (admission.cause) {
    case SourceRefusal::kNoName:
      return fmt::format("they name no source; expected `source` to have 1 to {} bytes",
                         kMaxSourceLength);
    case SourceRefusal::kTooMany:
      return fmt::format("source '{}' is one too many, since {} are heard", source.view(),
                         kMaxSources);
    case SourceRefusal::kOtherWriter:
      break;
  }
  return fmt::format("source '{}' is writer {}", source.view(),
                     options_.writer_name(admission.former_writer));
}

void Intake::tell_of(const Admission& admission, const PoseBatch& batch, std::uint64_t writer) {
  const SourceName& source = batch.source;
  const char* const inputs = batch.joints.empty() ? "poses" : "joints";
  switch (admission.news) {
    case Admission::News::kNothing:
      return;
    case Admission::News::kNewSource: {
      const std::string_view before = admission.place_of.view();
      const std::string place = before.empty() ? "" : fmt::format(", in the place of '{}'", before);
      return tell(News(lines::kNewSource, inputs, source.view(), place));
    }
    case Admission::News::kTakenOver:
      return tell(News(lines::kSourceTakenOver, source.view(), options_.writer_name(writer),
                       options_.writer_name(admission.former_writer)));
    case Admission::News::kFirstRefusal:
      return tell(News(lines::kSourceRefused, inputs, options_.writer_name(writer),
                       why_refused(admission, source)));
  }
}

}  // namespace clearance
