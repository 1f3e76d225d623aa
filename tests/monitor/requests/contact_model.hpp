// The contacts that a running monitor has to have, by their history and by monitors built anew.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>

#include "tests/monitor/requests/rebuilt_monitor.hpp"

namespace clearance::test {

class ContactModel {
 public:
  // After the settling ticks of a changed cell. `in_force` has all contacts without an end, `ended`
  // has them after their ends. `began_after`: a cycle before the change.
  void expect_right(const Scene& scene, const Report& report, std::uint64_t began_after,
                    const RebuiltMonitor& in_force, const RebuiltMonitor& ended,
                    Agreement& figures) {
    const std::vector<ContactPair> pairs = contact_pairs(scene);
    ASSERT_EQ(report.contacts.size(), pairs.size());
    std::map<Key, Known> now;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const ContactReport& contact = report.contacts[i];
      const AllowedContact& allowed = scene.contacts[pairs[i].contact];
      SCOPED_TRACE("contact " + allowed.name);
      EXPECT_EQ(contact.pair, pairs[i].pair);
      const bool has_ended = contact.ended != ContactEnded::kNot;
      const RebuiltMonitor& rebuilt = has_ended ? ended : in_force;
      EXPECT_EQ(std::string(name(contact.status)), name(rebuilt.report().contacts[i].status));
      const auto before = known_.find(key(scene, pairs[i]));
      const bool goes_on = before != known_.end() && before->second.depth == allowed.depth &&
                           before->second.end == allowed.end;
      if (goes_on) {
        EXPECT_EQ(contact.since_cycle, before->second.report.since_cycle);
        EXPECT_EQ(contact.since_ns, before->second.report.since_ns);
        if (before->second.report.ended != ContactEnded::kNot) {
          EXPECT_EQ(contact.ended, before->second.report.ended);
          EXPECT_EQ(contact.ended_cycle, before->second.report.ended_cycle);
        }
      } else {
        EXPECT_GT(contact.since_cycle, began_after);
      }
      expect_right_end(contact, allowed.end, report, in_force.monitor().pair(contact.pair));
      now[key(scene, pairs[i])] = {contact, allowed.depth, allowed.end};
      ++figures.contacts;
      figures.contacts_allowed += contact.status == ContactStatus::kAllowed;
      figures.contacts_ended += has_ended;
    }
    known_ = std::move(now);
  }

 private:
  using Key = std::tuple<std::string, std::string, std::string>;
  struct Known {
    ContactReport report;
    double depth = 0.0;
    ContactEnd end;
  };

  static Key key(const Scene& scene, const ContactPair& pair) {
    const ObjectPair& of = scene.pairs[pair.pair];
    const auto [a, b] = std::minmax(scene.objects[of.first].name, scene.objects[of.second].name);
    return {scene.contacts[pair.contact].name, a, b};
  }

  static void expect_right_end(const ContactReport& contact, const ContactEnd& end,
                               const Report& report, const PairReport& bounds) {
    const bool is_timed = end.duration_ns != ContactEnd::kNoTime;
    const bool is_late = report.now_ns > end.time_ns ||
                         (is_timed && report.now_ns - contact.since_ns > end.duration_ns);
    const bool is_past = report.cycle > end.last_cycle;
    const bool is_far = bounds.lower >= end.distance;
    if (is_late || is_past || is_far) {
      EXPECT_NE(name(contact.ended), std::string(name(ContactEnded::kNot)));
    }
    if (contact.ended == ContactEnded::kByDistance) {
      EXPECT_LT(end.distance, kInfinity);
    }
    if (contact.ended == ContactEnded::kByTime) {
      EXPECT_TRUE(is_late);
    }
    if (contact.ended == ContactEnded::kByCycle) {
      EXPECT_TRUE(is_past);
    }
    EXPECT_EQ(contact.ended_cycle != 0, contact.ended != ContactEnded::kNot);
  }

  std::map<Key, Known> known_;
};

}  // namespace clearance::test
