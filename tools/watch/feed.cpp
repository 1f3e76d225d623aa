#include "tools/watch/feed.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "monitor/interface/pair_name.hpp"
#include "monitor/interface/report.hpp"

namespace clearance::watch {
namespace {

// A terminal may block the program for a second; the reader keeps the reports of that time.
constexpr std::int32_t kDepth = 2048;
// The time for which a state of the partners is shown although a better one has come.
constexpr std::int64_t kShownNs = 1'000'000'000;

}  // namespace

Feed::Feed(client::Connection& connection)
    : reports_(connection, {.old_after = kOldReport, .depth = kDepth}),
      catalogue_(connection),
      health_(connection),
      zones_(connection),
      separation_(connection, {.depth = kDepth}),
      shares_(std::make_unique<client::ShareNames>(connection)) {}

void Feed::take(std::int64_t now_ns) {
  catalogue_.update();
  health_.update();
  separation_.newest();
  while (reports_.next()) {
    last_ns_ = now_ns;
    note_report(now_ns);
  }
  any() ? zones_.update(*reports_) : zones_.update();
  if (any()) shares_.reset();
  if (shares_) shares_->poll();
}

void Feed::note_report(std::int64_t now_ns) {
  const ReportCheck& check = reports_.check();
  if (check.other_daemon) begin_again();
  daemons_.insert(reports_->daemon);
  missed_ += check.missed;
  ++count_;
  const client::PartnerCheck& partner = reports_.partner();
  ++partner_counts_.at(static_cast<std::size_t>(partner.state));
  const std::int64_t shown_ns = now_ns - partner_ns_;
  if (partner.state >= partner_.state || shown_ns < 0 || shown_ns > kShownNs) {
    partner_ = partner;
    partner_ns_ = now_ns;
  }
  if (check.is_old) {
    old_ = {.count = old_.count + 1,
            .oldest_ns = std::max(old_.oldest_ns, check.age_ns),
            .last_ns = now_ns};
  }
  // A stale distance is that of an old pose.
  const clearance_msg_PairDistance& minimum = reports_->minimum;
  if (!reports_->minimum_known || minimum.status >= static_cast<std::uint8_t>(PairStatus::kStale)) {
    return;
  }
  if (smallest_.known && !(minimum.distance < smallest_.pair.distance)) return;
  smallest_ = {
      .known = true, .pair = minimum, .name = pair_name(minimum), .cycle = reports_->cycle};
}

// Called when the daemon was restarted, perhaps with another cell whose ids mean other objects, or
// when two daemons alternate, which is no restart. The new one's zones may be here before its first
// report.
void Feed::begin_again() {
  const std::uint64_t daemon = reports_->daemon;
  if (daemon == 0 || !daemons_.contains(daemon)) ++restarts_;
  smallest_ = {};
  if (*reports_->partner == '\0') zones_.keep_only(daemon);
}

std::set<std::string> Feed::shares() const {
  return shares_ ? shares_->names() : std::set<std::string>();
}

const clearance_msg_Catalogue* Feed::catalogue() const noexcept {
  return any() ? catalogue_.message(reports_->scene_revision) : catalogue_.message();
}

const clearance_msg_Health* Feed::health() const noexcept {
  const clearance_msg_Health* const health = health_.message();
  return health != nullptr && (!any() || health->daemon == reports_->daemon || has_partner())
             ? health
             : nullptr;
}

std::string Feed::object_name(std::uint32_t object) const {
  return catalogue_.object_name(object, reports_->scene_revision);
}

std::string Feed::pair_name(const clearance_msg_PairDistance& pair) const {
  return catalogue_.pair_name(pair, reports_->scene_revision);
}

std::string Feed::pair_name(std::uint32_t pair) const {
  const clearance_msg_Catalogue* const known = catalogue();
  if (known == nullptr || pair >= known->pairs._length) return fmt::format("pair {}", pair);
  const clearance_msg_CataloguePair& objects = known->pairs._buffer[pair];
  return clearance::pair_name(object_name(objects.object_a), object_name(objects.object_b));
}

std::string Feed::zone_name(std::uint32_t zone) const {
  const clearance_msg_Catalogue* const known = catalogue();
  if (known == nullptr || zone >= known->zones._length) return fmt::format("zone {}", zone);
  return known->zones._buffer[zone].name;
}

std::string Feed::robot_name(std::uint32_t robot) const {
  const clearance_msg_Catalogue* const known = catalogue();
  if (known == nullptr || robot >= known->robots._length) return fmt::format("robot {}", robot);
  return known->robots._buffer[robot];
}

}  // namespace clearance::watch
