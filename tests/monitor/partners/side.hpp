// One of two daemons without DDS: the test carries notices and states, and moves its clock.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "monitor/files/build_info.hpp"
#include "monitor/loop/joined_state.hpp"
#include "monitor/partners/tick_partner.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/wire/partner_state.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/small_cells.hpp"
#include "tests/monitor/taken_over.hpp"

namespace clearance::test {

inline constexpr std::int64_t kAloneAfter = 20 * kTick;

// Four moving bodies, and a zone that they enter and leave. The budget does not cover all pairs.
inline Scene cell_of_partners() {
  std::vector<Object> objects;
  for (const char* name : {"a", "b", "c", "d"}) {
    objects.push_back(moving(name, {ball(0.1), capsule(0.4, 0.05)}));
    objects.back().max_speed = 5.0;
  }
  Scene scene = cell_of(std::move(objects));
  scene.rate_hz = 1000;
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones.push_back(zone_over(scene, 0.3, 0.4));
  scene.budget = 8;
  return scene;
}

// One daemon, ticked as its loop does.
class Side {
 public:
  Side(const Scene& scene, std::uint64_t daemon)
      : scene_(scene),
        ids(scene),
        monitor(std::make_unique<Monitor>(scene)),
        frames(scene.sensors.size()),
        ticks(poses, clock,
              {.daemon = daemon,
               .start_ns = static_cast<std::int64_t>(daemon),
               .batch = {.samples = 16},
               .alone_after_ns = kAloneAfter,
               .frames = scene.sensors.empty() ? nullptr : &frames}) {}

  // A source sends this, in every tick another pose.
  void get(std::uint64_t number, const char* source = "arm") {
    poses.add(source, number, std::vector<JointSample>{});
    poses.last().samples = samples(number);
    poses.last().scene_revision = scene_.revision;
  }
  static std::vector<PoseSample> samples(std::uint64_t number) {
    std::vector<PoseSample> list;
    const double t = 0.001 * static_cast<double>(number);
    for (std::uint32_t i = 0; i < 4; ++i) {
      list.push_back(sample(i, at(0.6 * i + 0.3 * std::sin(7 * t + i), 0.2 * t, 0),
                            kStart + static_cast<std::int64_t>(number) * kTick));
    }
    return list;
  }

  void tick() {
    deadline_ += kTick;
    clock.sleep_until(deadline_ - ticks.ahead_ns());
    deadline_ = ticks.decide(deadline_, monitor->cycle() + 1, scene_.revision);
    poses_.clear();
    joints_.clear();
    used.clear();
    std::map<std::string, SourceUse> uses;
    while (const PoseBatch* batch = ticks.next()) {
      used.push_back(batch->sequence_number);
      uses[batch->source.c_str()] = {batch->source, batch->sequence_number};
      if (recorder_ != nullptr) recorder_->poses(*batch);
      EXPECT_TRUE(ids.append(*batch, poses_, joints_));
    }
    frames.show(scene_.revision, *monitor, {});
    const Report& report = monitor->tick(poses_, joints_, ticks.time());
    cycle = report.cycle;
    now_ns = report.now_ns;
    ticks.ticked(*monitor);
    if (recorder_ != nullptr) {
      std::vector<SourceUse> list;
      for (const auto& [source, use] : uses) list.push_back(use);
      recorder_->report(report, list, report.now_ns, ticks.lineage());
    }
    tag = {};
    if (const TickTag* front = ticks.tags().front()) {
      tag = *front;
      ticks.tags().pop();
    }
    spoke = tag.publishes;
    checksum = checksum_of(report);
    rest = checksum_of_rest(report, tag.state_checksum);
  }
  void rest_for(std::int64_t ns) {
    clock.pass(ns);
    deadline_ = clock.monotonic_ns();
  }
  // The notices of this one reach the other.
  void tell(Side& other) {
    for (; const TickNotice* notice = ticks.notices().front(); ticks.notices().pop()) {
      ++notices;
      EXPECT_TRUE(other.ticks.hear(*notice));
    }
  }
  void drop_notices() {
    while (ticks.notices().front() != nullptr) ticks.notices().pop();
  }
  // The other one joins with the state of this one's successor, which this one ticks from then on.
  void give_state(Side& other) {
    monitor = taken_over(*monitor, scene_, scene_, ids.sources());
    ticks.successor_begins(true);
    std::vector<std::byte> bytes;
    save_state(ids.sources(), ids, *monitor, bytes);
    JoinedState joined(scene_);
    ASSERT_TRUE(joined.restore(bytes, ticks.becoming()));
    if (!joined.has_frames(other.frames)) return ticks.successor_followed();
    joined.join(other.monitor, other.ids);
    ASSERT_TRUE(joined.has_joined());
    other.frames.show_awaited(*other.monitor, {});
    other.ticks.joined(joined.lineage(), other.monitor->cycle());
    if (other.recorder_ != nullptr) {
      const PartnerStateView state{scene_.revision, joined.lineage(), monitor->cycle(), bytes};
      other.recorder_->joined(CdrEncoder().encode(*to_wire(state, kBuild)));
    }
    ticks.successor_followed();
    if (recorder_ != nullptr)
      recorder_->change(*cell_, {.began_after = monitor->cycle(), .from = monitor->cycle() + 1});
  }
  // The recorder gets its ticks from now on, as that of a daemon. `cell` is that of its scene.
  void record(Recorder& recorder, const Cell& cell) {
    recorder_ = &recorder;
    cell_ = &cell;
  }

 private:
  const Scene& scene_;
  std::vector<PoseSample> poses_;
  std::vector<JointSample> joints_;
  std::int64_t deadline_ = 0;
  Recorder* recorder_ = nullptr;
  const Cell* cell_ = nullptr;

 public:
  TurnedClock clock;
  ListedPoses poses;
  SceneIds ids;
  std::unique_ptr<Monitor> monitor;
  FrameExchange frames;
  TickPartner ticks;
  std::vector<std::uint64_t> used;
  TickTag tag;
  std::uint64_t cycle = 0, checksum = 0, rest = 0;
  std::int64_t now_ns = 0;
  int notices = 0;
  bool spoke = false;
};

}  // namespace clearance::test
