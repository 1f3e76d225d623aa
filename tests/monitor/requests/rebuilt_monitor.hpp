// A monitor that is built anew from the text of a cell and gets the same inputs, and what has to
// agree with it.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/requests/block_distance.hpp"
#include "tests/monitor/requests/random_commands_cell.hpp"

namespace clearance::test {

// The ticks at rest that both monitors run, and what was sent before to what is silent now.
struct SettledInputs {
  std::int64_t first_tick_ns = 0;
  int ticks = 0;
  std::map<std::string, std::int64_t> last_sent = {};
};

class RebuiltMonitor {
 public:
  RebuiltMonitor(const Scene& scene, RandomSenders& senders, const SettledInputs& inputs)
      : monitor_(scene) {
    SceneIds ids(scene);
    std::vector<PoseSample> poses;
    std::vector<JointSample> joints;
    const auto tick = [&](std::int64_t now) {
      report_ = &monitor_.tick(poses, joints, now);
      poses.clear();
      joints.clear();
    };
    std::multimap<std::int64_t, std::string> before;
    for (const auto& [name, stamp] : inputs.last_sent) {
      if (stamp < inputs.first_tick_ns) before.emplace(stamp, name);
    }
    for (const auto& [stamp, name] : before) {
      const PoseBatch batch = senders.batch_of(name, stamp);
      EXPECT_TRUE(ids.append(batch, poses, joints));
      tick(stamp);
    }
    const auto period = static_cast<std::int64_t>(1e9 / scene.rate_hz);
    for (int k = 0; k < inputs.ticks; ++k) {
      const std::int64_t now = inputs.first_tick_ns + k * period;
      for (const PoseBatch& batch : senders.batches_at(now))
        EXPECT_TRUE(ids.append(batch, poses, joints));
      tick(now);
    }
  }
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }
  [[nodiscard]] const Report& report() const { return *report_; }

 private:
  Monitor monitor_;
  const Report* report_ = nullptr;
};

// The scene with an endless allowance for each contact, or one that has ended before it began.
inline Scene with_contacts(Scene scene, bool in_force) {
  for (AllowedContact& contact : scene.contacts) {
    contact.end = {};
    if (!in_force) contact.end.last_cycle = 0;
  }
  return scene;
}

// Figures of a campaign.
struct Agreement {
  std::uint64_t pairs = 0, known = 0, true_distances = 0, zones_decided = 0, zones_open = 0;
  std::uint64_t contacts = 0, contacts_allowed = 0, contacts_ended = 0;
  double widest = 0.0;  // of the bounds of evaluated pairs, m
};

// All poses rest. `running` has ticked through all changes.
class Comparison {
 public:
  Comparison(const Scene& scene, const Monitor& running, const Report& report,
             const RebuiltMonitor& rebuilt, const std::vector<Pose>& world, Agreement& figures)
      : scene_(scene),
        running_(running),
        report_(report),
        rebuilt_(rebuilt),
        world_(world),
        figures_(figures) {}

  void expect_equal_pairs() {
    long double least = kInfinity;
    for (std::uint32_t p = 0; p < scene_.pairs.size(); ++p) expect_equal(p, least);
    if (least < kInfinity) {
      EXPECT_LE(report_.lower_all, least + kRounding);
    }
    EXPECT_EQ(report_.unknown, rebuilt_.report().unknown);
    EXPECT_EQ(report_.stale, rebuilt_.report().stale);
    EXPECT_EQ(absent_pairs(report_), absent_pairs(rebuilt_.report()));
    ASSERT_EQ(report_.minimum_known, rebuilt_.report().minimum_known);
    if (report_.minimum_certified && rebuilt_.report().minimum_certified) {
      EXPECT_NEAR(report_.minimum.distance, rebuilt_.report().minimum.distance, kRounding);
    }
  }

  // Oracle: the thresholds and the bounds of the rebuilt monitor.
  void expect_right_zones() {
    ASSERT_EQ(report_.zones.size(), scene_.zones.size());
    for (std::size_t z = 0; z < scene_.zones.size(); ++z) {
      const Zone& zone = scene_.zones[z];
      bool is_inside = false, is_outside = true;
      for (const std::uint32_t p : zone.pairs) {
        const PairReport bounds = rebuilt_.monitor().pair(p);
        if (bounds.status == PairStatus::kAbsent || is_allowed(p)) continue;
        const ObjectPair& pair = scene_.pairs[p];
        const double margins =
            scene_.objects[pair.first].margin + scene_.objects[pair.second].margin;
        is_inside = is_inside || bounds.status == PairStatus::kUnknown ||
                    bounds.upper - margins < zone.enter_below - kRounding;
        is_outside = is_outside && bounds.lower - margins > zone.leave_above + kRounding &&
                     running_.pair(p).lower - margins > zone.leave_above + kRounding;
      }
      if (is_inside) {
        EXPECT_TRUE(report_.zones[z].active) << zone.name;
      }
      if (is_outside) {
        EXPECT_FALSE(report_.zones[z].active) << zone.name;
      }
      ++(is_inside || is_outside ? figures_.zones_decided : figures_.zones_open);
    }
  }

 private:
  // The error of distances of metres: the oracle has the bodies as their doubles say, and they have
  // errors.
  static constexpr double kRounding = 1e-9;

  static bool is_known(PairStatus status) { return status < PairStatus::kStale; }

  [[nodiscard]] bool is_allowed(std::uint32_t pair) const {
    const auto found = std::ranges::find(report_.contacts, pair, &ContactReport::pair);
    return found != report_.contacts.end() && found->status == ContactStatus::kAllowed;
  }

  void expect_equal(std::uint32_t p, long double& least) {
    const ObjectPair& pair = scene_.pairs[p];
    const Object &a = scene_.objects[pair.first], &b = scene_.objects[pair.second];
    SCOPED_TRACE(a.name + " - " + b.name);
    const PairReport now = running_.pair(p), anew = rebuilt_.monitor().pair(p);
    ++figures_.pairs;
    if (is_known(now.status) && is_known(anew.status) && !pair.publish) {
      // Carried or evaluated.
    } else {
      EXPECT_EQ(name(now.status), std::string(name(anew.status)));
    }
    EXPECT_EQ(now.age_a_ns, anew.age_a_ns);
    EXPECT_EQ(now.age_b_ns, anew.age_b_ns);
    if (now.status == PairStatus::kAbsent) return;
    EXPECT_LE(now.lower, anew.upper + kRounding);
    EXPECT_LE(anew.lower, now.upper + kRounding);
    if (now.status == PairStatus::kUnknown) {
      EXPECT_EQ(now.lower, -kInfinity);
      return;
    }
    ++figures_.known;
    if (pair.publish && now.status == PairStatus::kConverged) {
      EXPECT_NEAR(now.lower, anew.lower, kRounding);
      EXPECT_NEAR(now.upper, anew.upper, kRounding);
      figures_.widest = std::max(figures_.widest, now.upper - now.lower);
    }
    const auto truth = block_distance(a, world_[pair.first], b, world_[pair.second]);
    if (!truth) return;
    ++figures_.true_distances;
    least = std::min(least, *truth);
    EXPECT_LE(now.lower, *truth + kRounding);
    EXPECT_GE(now.upper, *truth - kRounding);
    EXPECT_LE(anew.lower, *truth + kRounding);
    EXPECT_GE(anew.upper, *truth - kRounding);
  }

  const Scene& scene_;
  const Monitor& running_;
  const Report& report_;
  const RebuiltMonitor& rebuilt_;
  const std::vector<Pose>& world_;
  Agreement& figures_;
};

}  // namespace clearance::test
