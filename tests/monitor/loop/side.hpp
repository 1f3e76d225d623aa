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
#include "monitor/loop/tick_partner.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/tick/tick_state.hpp"
#include "monitor/wire/partner_state.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/loop/listed_ports.hpp"
#include "tests/monitor/tick/small_cells.hpp"

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
        frames(scene.sensors.size()),
        ticks(poses, clock,
              {.daemon = daemon,
               .start_ns = static_cast<std::int64_t>(daemon),
               .batch = {.samples = 16},
               .alone_after_ns = kAloneAfter,
               .frames = scene.sensors.empty() ? nullptr : &frames}),
        state(scene, {.frames = &frames, .pace = &ticks}) {
    // The thread that hears goes on while the loop sleeps.
    clock.while_asleep = [this](int) { ticks.end_pass(); };
  }

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
    deadline_ = state.decide(deadline_);
    used.clear();
    std::map<std::string, SourceUse> uses;
    while (const PoseBatch* batch = ticks.next()) {
      used.push_back(batch->sequence_number);
      uses[batch->source.c_str()] = {batch->source, batch->sequence_number};
      if (recorder_ != nullptr) recorder_->poses(*batch);
      EXPECT_TRUE(state.use(*batch));
    }
    const Report& report = state.tick(ticks.time());
    state.clear();
    cycle = report.cycle;
    now_ns = report.now_ns;
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
  // A monitor of the same scene begins with the state after the last tick.
  void begin_successor() {
    next_ = std::make_unique<Successor>(state, scene_, records_);
    ASSERT_TRUE(state.begin(*next_));
  }
  // Ticks that one from now on.
  void succeed() {
    state.succeed();
    if (recorder_ != nullptr) recorder_->change(*cell_, next_->in_force());
  }
  // The other one joins with the state of this one's successor, which this one ticks from then on.
  void give_state(Side& other) {
    begin_successor();
    std::vector<std::byte> bytes;
    next_->save(state.ids(), bytes);
    JoinedState joined(scene_);
    ASSERT_TRUE(joined.restore(bytes, ticks.becoming()));
    if (other.state.may_join(joined)) {
      other.state.join(joined);
      if (other.recorder_ != nullptr) {
        const PartnerStateView view{scene_.revision, joined.lineage(), state.cycle(), bytes};
        other.recorder_->joined(CdrEncoder().encode(*to_wire(view, kBuild)));
      }
    }
    succeed();
  }
  // The recorder gets its ticks from now on, as that of a daemon. `cell` is that of its scene.
  void record(Recorder& recorder, const Cell& cell) {
    recorder_ = &recorder;
    cell_ = &cell;
  }

 private:
  const Scene& scene_;
  TickRecords records_{TickRecords::kNoRoom};
  std::unique_ptr<Successor> next_;
  std::int64_t deadline_ = 0;
  Recorder* recorder_ = nullptr;
  const Cell* cell_ = nullptr;

 public:
  TurnedClock clock;
  ListedPoses poses;
  FrameExchange frames;
  TickPartner ticks;
  TickState state;
  std::vector<std::uint64_t> used;
  TickTag tag;
  std::uint64_t cycle = 0, checksum = 0, rest = 0;
  std::int64_t now_ns = 0;
  int notices = 0;
  bool spoke = false;
};

}  // namespace clearance::test
