#include "monitor/zones/contacts.hpp"

#include <algorithm>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/zones/contact_end.hpp"

namespace clearance {
namespace {

// The condition by which an allowance has ended in this tick.
ContactEnded ended_by(bool was_far, std::int64_t last_ns, std::uint64_t last_cycle,
                      std::int64_t now_ns, std::uint64_t cycle) noexcept {
  if (was_far) return ContactEnded::kByDistance;
  if (now_ns > last_ns) return ContactEnded::kByTime;
  return cycle > last_cycle ? ContactEnded::kByCycle : ContactEnded::kNot;
}

// Every pose is known, on time and connected to the one before.
bool is_certain(const TrackedObject& object) noexcept {
  return object.known() && !object.input.late && !object.discontinuous;
}

ContactStatus status_in_force(double least_allowed, const PairBounds& bounds,
                              const TrackedObject& a, const TrackedObject& b) noexcept {
  if (!is_certain(a) || !is_certain(b)) return ContactStatus::kUnknown;
  if (bounds.swept_lower >= least_allowed) return ContactStatus::kAllowed;
  // If it could be deeper only because an object was late before this tick, that is the cause.
  const double unobserved = a.unobserved + b.unobserved;
  const bool is_late = bounds.lower >= least_allowed && unobserved > 0.0 &&
                       bounds.swept_lower + unobserved >= least_allowed;
  return is_late ? ContactStatus::kUnknown : ContactStatus::kTooDeep;
}

ContactStatus status_after_end(const PairBounds& bounds, const TrackedObject& a,
                               const TrackedObject& b) noexcept {
  if (!is_certain(a) || !is_certain(b)) return ContactStatus::kUnknown;
  return bounds.swept_lower > 0.0 ? ContactStatus::kEnded : ContactStatus::kTooLate;
}

}  // namespace

Contacts::Contacts(const Scene& scene) {
  for (const ContactPair& each : contact_pairs(scene)) {
    const AllowedContact& contact = scene.contacts[each.contact];
    entries_.push_back({.least_allowed = -contact.depth, .end = contact.end});
    reports_.push_back({.contact = each.contact, .pair = each.pair, .depth = kInfinity});
  }
}

void Contacts::take_over(const Contacts& before, const SceneMap& map) noexcept {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t old = map.contact_pairs[i];
    if (old == SceneMap::kNone) continue;
    const ContactReport place = reports_[i];
    entries_[i] = before.entries_[old];
    reports_[i] = before.reports_[old];
    reports_[i].contact = place.contact;
    reports_[i].pair = place.pair;
  }
}

void Contacts::save(StateWriter& out) const {
  out.put(std::span(entries_));
  out.put(std::span(reports_));
}

void Contacts::restore(StateReader& in, std::int64_t now_ns) noexcept {
  const std::vector<Entry> entries = entries_;
  const std::vector<ContactReport> reports = reports_;
  in.take(std::span(entries_));
  in.take(std::span(reports_));
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const ContactReport& report = reports_[i];
    in.expect(entries_[i].least_allowed == entries[i].least_allowed &&
              entries_[i].end == entries[i].end && are_flags(entries_[i].was_far));
    in.expect(report.contact == reports[i].contact && report.pair == reports[i].pair &&
              report.status <= ContactStatus::kAbsent && report.ended <= ContactEnded::kByCycle);
    in.expect(report.since_cycle == 0 ||
              (report.since_ns <= now_ns &&
               entries_[i].last_ns == last_time_of(entries[i].end, report.since_ns)));
  }
}

void Contacts::begin_tick(std::uint64_t cycle, std::int64_t now_ns) noexcept {
  any_allowed_ = false;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    ContactReport& report = reports_[i];
    Entry& entry = entries_[i];
    if (report.since_cycle == 0) {
      report.since_cycle = cycle;
      report.since_ns = now_ns;
      entry.last_ns = last_time_of(entry.end, now_ns);
    }
    if (report.ended != ContactEnded::kNot) continue;
    report.ended = ended_by(entry.was_far, entry.last_ns, entry.end.last_cycle, now_ns, cycle);
    if (report.ended == ContactEnded::kNot) continue;
    report.ended_cycle = cycle;
    report.ended_ns = now_ns;
  }
}

void Contacts::judge(std::size_t index, const PairBounds& bounds, const TickView& view) noexcept {
  Entry& entry = entries_[index];
  ContactReport& report = reports_[index];
  const PairEntry& of = view.pairs.entries[report.pair];
  const TrackedObject &a = view.objects[of.object_a], &b = view.objects[of.object_b];
  report.depth = std::max(0.0, -bounds.swept_lower);
  if (a.absent || b.absent) {
    report.status = ContactStatus::kAbsent;
  } else if (report.ended != ContactEnded::kNot) {
    report.status = status_after_end(bounds, a, b);
  } else {
    report.status = status_in_force(entry.least_allowed, bounds, a, b);
  }
  any_allowed_ = any_allowed_ || report.status == ContactStatus::kAllowed;
  if (bounds.lower >= entry.end.distance) entry.was_far = true;
}

const ContactReport* Contacts::find_entry(std::uint32_t pair) const noexcept {
  const auto found = std::ranges::lower_bound(reports_, pair, {}, &ContactReport::pair);
  return found == reports_.end() || found->pair != pair ? nullptr : &*found;
}

double Contacts::least_allowed_of(std::uint32_t pair) const noexcept {
  const ContactReport* report = find_entry(pair);
  if (report == nullptr || report->ended != ContactEnded::kNot) return kInfinity;
  return entries_[static_cast<std::size_t>(report - reports_.data())].least_allowed;
}

bool Contacts::is_allowed(std::uint32_t pair) const noexcept {
  const ContactReport* report = find_entry(pair);
  return report != nullptr && report->status == ContactStatus::kAllowed;
}

}  // namespace clearance
