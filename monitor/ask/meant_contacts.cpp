// Contacts that are meant: their pairs keep each margin as long as they are no deeper than allowed.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "config/scene/people.hpp"
#include "monitor/ask/motion_search.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

constexpr double kSecond = 1e-9;  // s in a ns

}  // namespace

// The scene's contacts count as if they came into force at the first waypoint. A time or a cycle
// that ends one is not on the clock of the waypoints, so such a contact does not count.
void MotionSearch::take_contacts_of_scene() {
  const double begin = posture_.trajectory().begin();
  for (const AllowedContact& contact : scene_.contacts) {
    const ContactEnd& end = contact.end;
    if (end.time_ns != ContactEnd::kNoTime || end.last_cycle != ContactEnd::kNoCycle) continue;
    const double until = end.duration_ns == ContactEnd::kNoTime
                             ? kInfinity
                             : begin + kSecond * static_cast<double>(end.duration_ns);
    for (const std::uint32_t pair : contact.pairs) {
      const ObjectPair& of = scene_.pairs[pair];
      contacts_.push_back({of.first, of.second, -contact.depth, until, end.distance});
    }
  }
}

std::optional<std::string> MotionSearch::take_contacts(const Question& question) {
  contacts_.clear();
  if (!question.contacts) {
    take_contacts_of_scene();
  } else {
    for (const MeantContact& stated : *question.contacts) {
      std::uint32_t objects[2] = {};
      int at = 0;
      for (const std::string* name : {&stated.first, &stated.second}) {
        const auto found = std::ranges::find(scene_.objects, *name, &Object::name);
        if (found == scene_.objects.end()) return "the cell has no object \"" + *name + "\"";
        objects[at++] = static_cast<std::uint32_t>(found - scene_.objects.begin());
      }
      if (!(stated.depth > 0.0)) return "the depth of a contact is not above 0";
      if (std::isnan(stated.until) || std::isnan(stated.distance))
        return "the end of a contact is not a number";
      const auto [first, second] = std::minmax(objects[0], objects[1]);
      if (auto text = contact_with_people(scene_.objects, scene_.robots, scene_.pairs, scene_.zones,
                                          first, second))
        return text;
      contacts_.push_back({first, second, -stated.depth, stated.until, stated.distance});
    }
  }
  if (contacts_.empty()) return std::nullopt;
  const auto key = [](const Meant& each) { return std::tuple(each.first, each.second); };
  std::ranges::sort(contacts_, {}, key);
  const auto twice = std::ranges::adjacent_find(contacts_, {}, key);
  if (twice != contacts_.end())
    return "two contacts are of \"" + scene_.objects[twice->first].name + "\" and \"" +
           scene_.objects[twice->second].name + "\"; expected one of each pair";
  contact_of_.assign(pairs_.pairs().size(), kNotMeant);
  for (std::uint32_t pair = 0; pair < contact_of_.size(); ++pair) {
    std::uint32_t first = 0, second = 0;
    note_pair(pair, first, second);
    const auto objects = std::tuple(std::min(first, second), std::max(first, second));
    const auto found = std::ranges::lower_bound(contacts_, objects, {}, key);
    if (found != contacts_.end() && key(*found) == objects)
      contact_of_[pair] = static_cast<std::uint32_t>(found - contacts_.begin());
  }
  return std::nullopt;
}

// Before any margin: a contact ends as soon as its objects may be as far apart as ends it.
void MotionSearch::end_contacts() noexcept {
  for (std::uint32_t contact = 0; contact < contacts_.size(); ++contact) {
    if (contacts_[contact].distance < kInfinity)
      static_cast<void>(stays_near(posture_.trajectory().whole(), contact));
  }
}

bool MotionSearch::stays_near(const Stretch& stretch, std::uint32_t contact) noexcept {
  Meant& meant = contacts_[contact];
  const double begin = posture_.trajectory().begin();
  const auto end_here = [&] {
    // At the first waypoint it may have ended.
    meant.near_until = std::min(meant.near_until, stretch.from > begin ? stretch.from : -kInfinity);
    return false;
  };
  if (stretch.from > std::min(meant.until, meant.near_until)) return true;
  if (is_exhausted()) {
    answer_->within_work_limit = false;
    return end_here();
  }
  const double middle = posture_.trajectory().middle(stretch);
  place(stretch, middle);
  for (const Bundle& bundle : pairs_.bundles()) {
    const auto of = std::span(contact_of_).subspan(bundle.first, bundle.end - bundle.first);
    if (std::ranges::find(of, contact) == of.end()) continue;
    const TipMotion motion = tip_motion(bundle, stretch, middle, posture_);
    for (std::uint32_t pair = bundle.first; pair < bundle.end; ++pair) {
      if (contact_of_[pair] != contact) continue;
      const Pair at = pair_at(pair, motion);
      const PairAtMiddle found = query(at, pair);
      if (rounded_up(found.upper + at.loss) < meant.distance) return true;
    }
  }
  if (!can_divide(stretch, middle) || stretch.to - stretch.from <= kInstant * duration_)
    return end_here();
  return stays_near(Trajectory::before(stretch, middle), contact) &&
         stays_near(Trajectory::after(stretch, middle), contact);
}

}  // namespace clearance
