#include "monitor/client/shared_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <set>
#include <span>
#include <string_view>

#include "monitor/client/sequence_view.hpp"
#include "monitor/client/share_names.hpp"
#include "monitor/client/share_readers.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance::client {
namespace {

// The first report waits so long for shares that may not have been met yet.
constexpr std::int64_t kMeeting = 1'000'000'000;

std::uint64_t random_number() {
  std::random_device random;
  std::uint64_t number = 0;
  while (number == 0) number = std::uint64_t{random()} << 32 | random();
  return number;
}

}  // namespace

SharedCell::SharedCell(Connection& connection, SharedCellOptions options)
    : connection_(connection),
      options_(std::move(options)),
      late_ns_(options_.late_after ? options_.late_after->count() : kLeastLate),
      daemon_(random_number()),
      checker_(options_.old_after.count()) {
  if (options_.names.empty()) {
    discovery_ = std::make_unique<ShareNames>(connection);
    wait_ = std::make_unique<DataWait>(connection.participant(), std::vector{discovery_->reader()});
  } else {
    open(options_.names);
  }
}

SharedCell::~SharedCell() { wait_.reset(); }

void SharedCell::open(const std::vector<std::string>& names) {
  wait_.reset();
  map_ = {};
  shares_.clear();
  joined_ns_ = 0;
  opened_at_ = monotonic_ns();
  std::vector<dds_entity_t> readers;
  if (discovery_) readers.push_back(discovery_->reader());
  for (const std::string& name : names) {
    shares_.push_back(
        std::make_unique<ShareStreams>(connection_, name, late_ns_, options_.gradients));
    readers.push_back(shares_.back()->reports.reader());
  }
  wait_ = std::make_unique<DataWait>(connection_.participant(), readers);
}

// Any share's catalogue names all of them.
void SharedCell::look_for_names() {
  std::vector<std::string> names;
  for (const auto& share : shares_) names.push_back(share->name);
  const std::size_t before = names.size();
  for (const std::string& name : discovery_->poll()) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  if (names.size() != before) open(names);
  for (const auto& share : shares_) {
    share->look_for_names();
    if (share->catalogue.message() == nullptr) continue;
    const ShareMap known(*share->catalogue.message());
    wait_.reset();
    discovery_.reset();
    return open(known.names());
  }
}

void SharedCell::take() {
  const std::int64_t now_ns = dds_time();
  for (const auto& share : shares_) share->take(now_ns);
  if (joined_ns_ != 0) return;
  // Reports before the first joined one are passed over: the program may have done other work.
  for (const auto& share : shares_) {
    while (share->has_ahead) {
      share->use();
      share->take(now_ns);
    }
  }
}

bool SharedCell::waits_for_first() const {
  if (joined_ns_ != 0) return false;
  const bool is_known = std::ranges::any_of(shares_, [this](const auto& share) {
    return catalogue_of(share->current.latest->scene_revision) != nullptr;
  });
  const std::int64_t waits_ns = std::max(late_ns_, kMeeting);
  return !is_known ||
         (monotonic_ns() - opened_at_ <= waits_ns &&
          !std::ranges::all_of(shares_, [](const auto& share) { return share->is_heard(); }));
}

// The caller is not told again what it was told of the partners of each share.
void SharedCell::begin_call() {
  for (const auto& share : shares_) {
    if (std::exchange(share->partner_is_told, false)) share->partner_is_old = true;
  }
}

bool SharedCell::next(std::chrono::nanoseconds timeout) {
  begin_call();
  return wait_for_next(timeout);
}

bool SharedCell::wait_for_next(std::chrono::nanoseconds timeout) {
  const std::int64_t end_ns = monotonic_ns() + timeout.count();
  for (;;) {
    if (discovery_) look_for_names();
    take();
    const std::int64_t now = dds_time();
    if (is_due(now)) {
      if (join(now)) return true;
      continue;
    }
    const std::int64_t left_ns = end_ns - monotonic_ns();
    if (left_ns <= 0) return false;
    wait_->wait(std::min(left_ns, late_ns_ / 4));
  }
}

bool SharedCell::newest(std::chrono::nanoseconds timeout) {
  begin_call();
  if (!wait_for_next(timeout)) return false;
  while (wait_for_next({})) {
  }
  return true;
}

// A share that is late or missing is not waited for.
bool SharedCell::is_due(std::int64_t now_ns) const {
  if (shares_.empty() || waits_for_first()) return false;
  const std::int64_t at = monotonic_ns();
  bool has_any = false, lacks_one = false;
  for (const auto& share : shares_) {
    if (share->has_ahead) return true;
    has_any = has_any || share->is_new;
    const std::int64_t age = less(now_ns, share->current.latest->publish_ns);
    lacks_one = lacks_one || (!share->is_new && age <= late_ns_ && at - share->came_at <= late_ns_);
  }
  if (has_any) return !lacks_one;
  return joined_ns_ != 0 && at - joined_at_ >= late_ns_;
}

void SharedCell::judge(std::int64_t now_ns) {
  checks_.clear();
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    ShareStreams* const share = shares_[i].get();
    share->used = share->report_of(map_.revision(), now_ns);
    if (share->used == nullptr) share->used = &*share->current.latest;
    const clearance_msg_Distances& report = *share->used;
    ShareCheck& check = checks_.emplace_back();
    check.name = share->name;
    check.daemon = report.daemon;
    check.cycle = report.cycle;
    check.scene_revision = report.scene_revision;
    check.partner = share->partner;
    share->partner_is_told = true;
    if (report.cycle == 0) continue;
    check.age_ns = less(now_ns, report.publish_ns);
    // The times of two machines are compared, so that silence counts as well.
    const bool is_late = check.age_ns > late_ns_ || share->taken_at - share->came_at > late_ns_;
    if (is_late && share->reports.daemons() == 0) continue;
    check.state = is_late || check.age_ns < -late_ns_        ? ShareState::kLate
                  : report.scene_revision != map_.revision() ? ShareState::kOtherRevision
                  : !is_divided_alike(i)                     ? ShareState::kOtherDivision
                  : share->is_held()                         ? ShareState::kHeld
                                                             : ShareState::kWhole;
  }
}

bool SharedCell::join(std::int64_t now_ns) {
  joined_ns_ = now_ns;
  joined_at_ = monotonic_ns();
  if (!follow_revision()) return false;
  judge(now_ns);
  std::vector<ShareView> views;
  for (std::size_t i = 0; i < map_.names().size() && i < shares_.size(); ++i) {
    ShareStreams& share = *shares_[i];
    ShareView& view = views.emplace_back();
    view.state = checks_[i].state;
    view.report = share.used;
    const auto of_now = [&](const auto& of_two) {
      const auto* const message = of_two.of(map_.revision());
      const bool is_late = message != nullptr && less(now_ns, message->publish_ns) > late_ns_;
      return is_late ? nullptr : message;
    };
    view.separation = of_now(share.separation);
    view.gradients = of_now(share.gradient);
  }
  const std::int64_t before_ns = message_->now_ns;
  join_reports(map_, views, *message_);
  // Without any share there is no time of a tick. That does not go back where a share comes again,
  // but where a clock was set. The report says truly when its oldest part was published.
  if (message_->now_ns == 0) message_->now_ns = now_ns;
  if (message_->publish_ns == 0) message_->publish_ns = now_ns;
  if (less(before_ns, message_->now_ns) < late_ns_)
    message_->now_ns = std::max(message_->now_ns, before_ns);
  message_->daemon = daemon_;
  ++message_->cycle;
  check_ = checker_.check(*message_, now_ns);
  join_zones();
  if (!map_.separated().empty() || !map_.stopping().empty()) {
    join_separations(map_, views, *separation_);
    sign(*separation_);
  }
  gradients_ = {};
  has_gradients_ =
      std::ranges::any_of(views, [](const ShareView& view) { return view.gradients != nullptr; });
  if (has_gradients_) {
    join_gradients(map_, views, *gradients_);
    sign(*gradients_);
  }
  for (const auto& share : shares_) share->use();
  return true;
}

template <class Message>
void SharedCell::sign(Message& message) const {
  message.daemon = daemon_;
  message.cycle = message_->cycle;
  message.now_ns = message_->now_ns;
  message.publish_ns = message_->publish_ns;
  message.scene_revision = message_->scene_revision;
}

void SharedCell::join_zones() {
  const clearance_msg_Catalogue* const names = catalogue();
  if (names == nullptr) return zones_.clear();
  std::map<std::uint32_t, clearance_msg_ZoneState> joined;
  std::vector<const clearance_msg_ZoneState*> of_shares(shares_.size());
  std::vector<clearance_msg_ZoneState> raised(shares_.size());
  for (const clearance_msg_CatalogueZone& zone : list(names->zones)) {
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      const bool is_used = checks_[i].state == ShareState::kWhole;
      of_shares[i] = is_used ? shares_[i]->zone(zone.id, zone.name, *shares_[i]->used) : nullptr;
      if (of_shares[i] == nullptr || !is_raised(*of_shares[i], *shares_[i]->used)) continue;
      raised[i] = *of_shares[i];
      raise(raised[i], *shares_[i]->used);
      of_shares[i] = &raised[i];
    }
    clearance_msg_ZoneState state = join_zone(map_, zone.id, of_shares);
    const std::string_view name = zone.name;
    std::memset(state.name, 0, sizeof state.name);
    name.copy(state.name, sizeof state.name - 1);
    state.daemon = daemon_;
    state.cycle = message_->cycle;
    state.now_ns = message_->now_ns;
    const auto before = zones_.find(zone.id);
    const bool is_as_before = before != zones_.end() && before->second.active == state.active &&
                              name.substr(0, sizeof state.name - 1) == before->second.name;
    state.since_cycle = is_as_before ? before->second.since_cycle : message_->cycle;
    joined[zone.id] = state;
    auto& active = message_->active_zones;
    if (state.active && active._length < active._maximum)
      active._buffer[active._length++] = zone.id;
  }
  zones_ = std::move(joined);
}

bool SharedCell::is_whole() const noexcept {
  return !checks_.empty() && std::ranges::all_of(checks_, [](const ShareCheck& check) {
    return check.state == ShareState::kWhole;
  });
}

ReportError SharedCell::reason() const noexcept {
  using enum ReportError;
  // A share may be late by late_after, or by as much ahead, where a reader of it alone may not.
  constexpr std::array kOfTime = {kGood, kNothingHeard, kOld, kClocksDisagree, kSilent};
  for (const auto& share : shares_) {
    const ReportError error = share->reports.reason();
    if (std::ranges::find(kOfTime, error) == kOfTime.end()) return error;
  }
  if (joined_at_ == 0) return kNothingHeard;
  if (!is_whole()) return kShare;
  return monotonic_ns() - joined_at_ <= late_ns_ ? kGood : kSilent;
}

void SharedCell::acknowledge() noexcept {
  for (const auto& share : shares_) share->acknowledge();
}

std::uint64_t SharedCell::missed() const noexcept {
  std::uint64_t all = 0;
  for (const auto& share : shares_) all += share->missed;
  return all;
}

std::string SharedCell::what_is_missing() const {
  std::string text;
  for (const ShareCheck& check : checks_) {
    if (check.state == ShareState::kWhole) continue;
    text += fmt::format("{}the share '{}' is {}", text.empty() ? "" : ", ", check.name,
                        client::name(check.state));
  }
  return text;
}

Sample<clearance_msg_Health> SharedCell::health() {
  Sample<clearance_msg_Health> joined;
  std::vector<const clearance_msg_Health*> of_shares;
  std::vector<const HealthCounts*> counts;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    ShareStreams& share = *shares_[i];
    share.health.update();
    const clearance_msg_Health* const health = share.health.message();
    if (health == nullptr) continue;
    share.counted.take(*health);
    counts.push_back(&share.counted);
    if (i < checks_.size() && checks_[i].state == ShareState::kWhole) of_shares.push_back(health);
  }
  join_health(of_shares, counts, *joined);
  joined->daemon = daemon_;
  joined->cycle = message_->cycle;
  joined->scene_revision = message_->scene_revision;
  if (joined->now_ns == 0) joined->now_ns = message_->now_ns;
  reserve_sequence(joined->shares, checks_.size());
  for (const ShareCheck& check : checks_) {
    clearance_msg_ShareHealth& to = joined->shares._buffer[joined->shares._length++];
    check.name.copy(to.share, sizeof to.share - 1);
    to.state = static_cast<std::uint8_t>(check.state);
    to.daemon = check.daemon;
    to.cycle = check.cycle;
    to.scene_revision = check.scene_revision;
    to.age_ns = check.age_ns;
  }
  return joined;
}

}  // namespace clearance::client
