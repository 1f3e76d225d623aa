// The daemon's streams and latched values. Each is taken into a second sample, and the two are
// swapped.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <set>
#include <span>
#include <type_traits>
#include <utility>

#include "monitor/client/client.hpp"
#include "monitor/client/sequence_view.hpp"
#include "monitor/interface/pair_name.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance::client {
namespace {

template <class T>
bool take_one(dds_entity_t reader, T& sample) {
  void* pointer = &sample;
  dds_sample_info_t info;
  while (dds_take(reader, &pointer, &info, 1, 1) > 0) {
    if (info.valid_data) return true;
  }
  return false;
}

template <class Message>
TopicKind kind_of() {
  for (const Topic& topic : kTopics) {
    if (topic.type == &topic_descriptor<Message>()) return topic.kind;
  }
  return TopicKind::kDistances;
}

template <class Sequence>
std::optional<std::uint32_t> id_of(const Sequence& named, std::string_view name) {
  for (const auto& one : list(named)) {
    if (name == one.name) return one.id;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> object_in(const clearance_msg_Catalogue* names,
                                       std::string_view name) {
  return names == nullptr ? std::nullopt : id_of(names->objects, name);
}

std::optional<std::uint32_t> pair_in(const clearance_msg_Catalogue* names, std::string_view a,
                                     std::string_view b) {
  const auto first = object_in(names, a), second = object_in(names, b);
  if (!first || !second) return std::nullopt;
  for (const clearance_msg_CataloguePair& pair : list(names->pairs)) {
    const bool same = pair.object_a == *first && pair.object_b == *second;
    const bool swapped = pair.object_a == *second && pair.object_b == *first;
    if (same || swapped) return pair.id;
  }
  return std::nullopt;
}

std::string part_name(const clearance_msg_Catalogue& names, std::uint32_t object,
                      std::uint32_t part) {
  if (object >= names.objects._length) return fmt::format("object {}", object);
  const clearance_msg_CatalogueObject& found = names.objects._buffer[object];
  if (part >= found.parts._length) return found.name;
  return body_name(found.name, found.parts._length, found.parts._buffer[part]);
}

}  // namespace

Connection::Connection(const DdsOptions& options, const Topics& topics)
    : participant_(std::make_unique<Participant>(options)), topics_(topics) {}
Connection::Connection(dds_entity_t participant, const std::string& partition, const Topics& topics)
    : participant_(std::make_unique<Participant>(participant, partition)), topics_(topics) {}
Connection::~Connection() = default;

const std::string& Connection::where() const noexcept { return participant_->where(); }

template <class Message>
Stream<Message>::Stream(Connection& connection, const StreamOptions& options)
    : reader_(connection.participant().reader(
          kind_of<Message>(), connection.topics().*topic(kind_of<Message>()).name, options.depth)),
      wait_(std::make_unique<DataWait>(connection.participant(), std::vector{reader_})),
      judge_(
          {options.old_after.count(), options.period.count(), options.error_interval.count()},
          connection.participant().address(connection.topics().*topic(kind_of<Message>()).name)) {}

template <class Message>
Stream<Message>::~Stream() {
  wait_.reset();
  dds_delete(reader_);
}

template <class Message>
bool Stream<Message>::take() {
  bool is_next = false;
  std::int64_t at_ns = 0;
  while (!is_next) {
    if (!take_one(reader_, *scratch_)) return false;
    at_ns = monotonic_ns();
    const ReportError error = judge_.refuse(*scratch_, at_ns);
    is_next = error == ReportError::kGood;
    if constexpr (std::is_same_v<Message, clearance_msg_Distances>) {
      const bool is_of_one = *scratch_->partner == '\0' && scratch_->checksum == 0;
      if (!is_of_one && (is_next || error == ReportError::kCorrupt))
        is_next = merge_.take(*scratch_, at_ns, is_next);
      if (is_next) static_cast<void>(whole_.complete(*scratch_));
    }
  }
  std::swap(*message_, *scratch_);
  check_ = judge_.check(*message_, now_ns(), at_ns);
  partner_ = merge_.check();
  return true;
}

// A writer that comes or leaves also ends the wait, with nothing to take.
template <class Message>
bool Stream<Message>::next(std::chrono::nanoseconds timeout) {
  const std::int64_t end_ns = monotonic_ns() + timeout.count();
  while (!take()) {
    const std::int64_t left_ns = end_ns - monotonic_ns();
    if (left_ns <= 0) return false;
    wait_->wait(left_ns);
  }
  return true;
}

// Skipped messages count as received.
template <class Message>
bool Stream<Message>::newest(std::chrono::nanoseconds timeout) {
  if (!next(timeout)) return false;
  PartnerCheck worst = partner_;
  while (take()) worst = worse(worst, partner_);
  partner_ = std::move(worst);
  return true;
}

template <class Message>
ReportError Stream<Message>::reason() const noexcept {
  return judge_.error(monotonic_ns());
}

template <class Message>
std::uint32_t Stream<Message>::daemons() const {
  return writers_alive(reader_);
}

template <class Message>
bool Stream<Message>::has_ended() const {
  return writers_there(reader_) == 0;
}

template <class Message>
std::string Stream<Message>::refusal() const {
  return why_unheard(reader_);
}

template class Stream<clearance_msg_Distances>;
template class Stream<clearance_msg_Gradients>;
template class Stream<clearance_msg_Separation>;

const clearance_msg_PairDistance* find(const clearance_msg_Distances& report,
                                       std::optional<std::uint32_t> pair) {
  for (const clearance_msg_PairDistance& published : list(report.pairs)) {
    if (published.pair == pair) return &published;
  }
  return nullptr;
}

Catalogue::Catalogue(Connection& connection)
    : reader_(connection.participant(), TopicKind::kCatalogue, connection.topics().catalogue,
              true) {}

// A catalogue that comes again, from a daemon that was started again, replaces the one before.
void Catalogue::update(const std::function<void(const clearance_msg_Catalogue&)>& each) {
  while (reader_.take(*scratch_)) {
    if (each) each(*scratch_);
    std::erase_if(kept_, [this](const Sample<clearance_msg_Catalogue>& known) {
      return known->scene_revision == scratch_->scene_revision;
    });
    kept_.emplace_front();
    std::swap(*kept_.front(), *scratch_);
    if (kept_.size() > kKept) kept_.pop_back();
  }
}

const clearance_msg_Catalogue* Catalogue::message(std::uint64_t revision) const noexcept {
  for (const Sample<clearance_msg_Catalogue>& known : kept_) {
    if (known->scene_revision == revision) return &*known;
  }
  return nullptr;
}

const clearance_msg_Catalogue* Catalogue::known(std::optional<std::uint64_t> revision) const {
  return revision ? message(*revision) : message();
}

std::optional<std::uint32_t> Catalogue::object(std::string_view name) const {
  return object_in(message(), name);
}

std::optional<std::uint32_t> Catalogue::joint(std::string_view name) const {
  return message() == nullptr ? std::nullopt : id_of(message()->joints, name);
}

std::optional<std::uint32_t> Catalogue::pair(std::string_view a, std::string_view b) const {
  return pair_in(message(), a, b);
}

std::string Catalogue::object_name(std::uint32_t object,
                                   std::optional<std::uint64_t> revision) const {
  const clearance_msg_Catalogue* const names = known(revision);
  if (names == nullptr || object >= names->objects._length) return fmt::format("object {}", object);
  return names->objects._buffer[object].name;
}

std::string Catalogue::joint_name(std::uint32_t joint,
                                  std::optional<std::uint64_t> revision) const {
  const clearance_msg_Catalogue* const names = known(revision);
  if (names == nullptr || joint >= names->joints._length) return fmt::format("joint {}", joint);
  return names->joints._buffer[joint].name;
}

std::string Catalogue::pair_name(const clearance_msg_PairDistance& pair,
                                 std::optional<std::uint64_t> revision) const {
  const clearance_msg_Catalogue* const names = known(revision);
  if (names == nullptr || pair.pair >= names->pairs._length)
    return fmt::format("pair {}", pair.pair);
  const clearance_msg_CataloguePair& objects = names->pairs._buffer[pair.pair];
  return clearance::pair_name(part_name(*names, objects.object_a, pair.part_a),
                              part_name(*names, objects.object_b, pair.part_b));
}

std::optional<std::uint32_t> Object::id(std::uint64_t revision) {
  if (revision_ == revision) return id_;
  if (catalogue_.message(revision) == nullptr) catalogue_.update();
  const clearance_msg_Catalogue* const names = catalogue_.message(revision);
  if (names == nullptr) return std::nullopt;
  revision_ = revision;
  return id_ = object_in(names, name_);
}

std::optional<std::uint32_t> Pair::id(std::uint64_t revision) {
  if (revision_ == revision) return id_;
  if (catalogue_.message(revision) == nullptr) catalogue_.update();
  const clearance_msg_Catalogue* const names = catalogue_.message(revision);
  if (names == nullptr) return std::nullopt;
  revision_ = revision;
  return id_ = pair_in(names, a_, b_);
}

const clearance_msg_PairGradient* Pair::in(const clearance_msg_Gradients& gradients) {
  const std::optional<std::uint32_t> pair = id(gradients.scene_revision);
  for (const clearance_msg_PairGradient& published : list(gradients.pairs)) {
    if (published.pair == pair) return &published;
  }
  return nullptr;
}

Health::Health(Connection& connection)
    : reader_(connection.participant(), TopicKind::kHealth, connection.topics().health) {}

// A follower's message counts if no leader's has come for 2.5 periods, or if the message in use is
// of the same daemon.
void Health::update() {
  while (reader_.take(*scratch_)) {
    const std::int64_t silent_ns = scratch_->period_ns / 2 * 5;
    const bool leads = *scratch_->partner.partner == '\0' || scratch_->partner.leads;
    if (leads) leader_ns_ = monotonic_ns();
    const bool has_leader = leader_ns_ != 0 && monotonic_ns() - leader_ns_ < silent_ns;
    if (!leads && has_leader && scratch_->daemon != message_->daemon) continue;
    std::swap(message_, scratch_);
    known_ = true;
  }
}

Zones::Zones(Connection& connection)
    : reader_(connection.participant(), TopicKind::kZones, connection.topics().zones, true) {}

void Zones::update() {
  clearance_msg_ZoneState state{};
  dds_sample_info_t info;
  std::set<std::uint32_t> changed;
  while (reader_.take(state, info, true)) {
    // A changed cell has fewer zones: others may have the names of those that are gone.
    if (info.instance_state == DDS_IST_NOT_ALIVE_DISPOSED) {
      written_.erase(state.zone);
      states_.erase(state.zone);
    } else if (info.valid_data) {
      written_[state.zone][state.daemon] = {state, info.publication_handle};
      changed.insert(state.zone);
    }
  }
  const bool has_several =
      std::ranges::any_of(written_, [](const auto& zone) { return zone.second.size() > 1; });
  if (has_several) forget_gone();
  for (const auto& [zone, of_daemons] : written_) {
    if (has_several || changed.contains(zone)) states_[zone] = latest(of_daemons);
  }
}

bool is_raised(const clearance_msg_ZoneState& state, const clearance_msg_Distances& report) {
  const auto listed = list(report.active_zones);
  return !state.active && std::ranges::find(listed, state.zone) != listed.end();
}

void raise(clearance_msg_ZoneState& state, const clearance_msg_Distances& report) {
  state.daemon = report.daemon;
  state.active = true;
  state.certified = false;
  state.cause = static_cast<std::uint8_t>(ZoneCause::kNear);
  state.clearance = state.swept_clearance = -std::numeric_limits<double>::infinity();
  state.since_cycle = state.cycle = report.cycle;
  state.now_ns = report.now_ns;
}

void Zones::update(const clearance_msg_Distances& report) {
  for (const std::uint32_t zone : std::exchange(raised_, {})) {
    const auto written = written_.find(zone);
    if (written == written_.end())
      states_.erase(zone);
    else
      states_[zone] = latest(written->second);
  }
  update();
  for (const std::uint32_t zone : list(report.active_zones)) {
    clearance_msg_ZoneState& state = states_[zone];
    state.zone = zone;
    if (!is_raised(state, report)) continue;
    raise(state, report);
    raised_.push_back(zone);
  }
}

// A daemon that has gone, or ticks apart, may have left its state of an earlier tick. A state that
// no other daemon has written again still counts.
void Zones::forget_gone() {
  const std::vector<std::uint64_t> there = writers_of(reader_.entity());
  const auto is_there = [&](const auto& of_daemon) {
    return std::ranges::count(there, of_daemon.second.writer) > 0;
  };
  for (auto& [zone, of_daemons] : written_) {
    if (std::ranges::any_of(of_daemons, is_there))
      std::erase_if(of_daemons, [&](const auto& one) { return !is_there(one); });
  }
}

// Among those of the same tick, an active one counts.
const clearance_msg_ZoneState& Zones::latest(const std::map<std::uint64_t, Written>& of_daemons) {
  const auto rank = [](const auto& one) {
    return std::pair(one.second.state.now_ns, one.second.state.active);
  };
  return std::ranges::max_element(of_daemons, {}, rank)->second.state;
}

void Zones::keep_only(std::uint64_t daemon) {
  for (auto& [zone, of_daemons] : written_)
    std::erase_if(of_daemons, [=](const auto& one) { return one.first != daemon; });
  std::erase_if(written_, [](const auto& zone) { return zone.second.empty(); });
  std::erase_if(states_, [this](const auto& zone) { return !written_.contains(zone.first); });
  for (const auto& [zone, of_daemons] : written_) states_[zone] = latest(of_daemons);
}

std::int64_t now_ns() noexcept { return dds_time(); }

std::int64_t monotonic_ns() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace clearance::client
