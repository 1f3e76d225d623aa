// Inputs with stepped clocks, and with lost, delayed and occasionally wild poses from several
// sources, compared with the true motion. No bound of a report is false and no zone is left
// wrongly, except for what the poses of the last age limit allow. In the end all faults stop, and
// everything has to be known again.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "monitor/loop/tick_loop.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
constexpr std::int64_t kOneSecond = 1000 * kTick;
constexpr std::int64_t kTicksASeed = 25'000;  // per seed, of 40 seeds
constexpr double kRadius = 0.05;
// An initial time without steps, losses and delays, so that every source is first heard with a
// correct clock.
constexpr std::int64_t kCalm = kOneSecond / 5;
// Until all is known again after the last fault. A dispute of two sources lasts for a second. A lie
// that was believed is up to 5.2 m away, which takes 2.6 s at the stated speed.
constexpr std::int64_t kKnownAgain = 3 * kOneSecond;
constexpr std::int64_t kTicksAfter = (kKnownAgain + kOneSecond) / kTick;

// The objects move at up to 1.9 m/s, and are metres away from where they were a second ago.
Vec3 true_position(std::uint32_t object, std::int64_t at_ns) {
  const double t = 1e-9 * static_cast<double>(at_ns);
  const double side = object == 0 ? -2.5 : 2.5;
  return {side + 1.3 * std::sin(1.1 * t + object), 0.9 * std::cos(0.7 * t),
          0.3 * std::sin(0.9 * t)};
}

// A program that sends the true pose of one object, from this machine or another.
struct TrueSource {
  std::string name;
  std::uint32_t object;
  bool elsewhere;
  std::uint64_t sequence = 0;
  std::int64_t sends_next = 0, comes_last = 0;     // true time, ns
  std::int64_t clock_ahead = 0;                    // of its own machine, if that is another one
  std::int64_t lost_until = 0, held_up_until = 0;  // true time, ns
  std::int64_t lies_until = 0;                     // true time, ns
  Vec3 lie = Vec3::Zero();                         // error of its poses until then, m
  bool lied = false;  // its last received pose was wrong, in position or time
};

struct BatchInFlight {
  std::int64_t comes = 0;
  PoseBatch batch;
  bool lies = false;
  std::int64_t made = 0, clock_ahead = 0;  // the latter applies to another machine
};

// The environment of the loop. True time is the time of the steady clock.
class HostileWorld final : public Clock, public PoseSource, public ReportSink {
 public:
  HostileWorld(const Scene& scene, std::uint32_t seed) : scene_(scene), random_(seed) {
    sources_ = {{"arm", 0, false}, {"tracker", 1, true}, {"spare", 0, true}, {"second", 1, false}};
  }

  std::int64_t realtime_ns() noexcept override { return kStart + now_ + wall_ahead_; }
  std::int64_t monotonic_ns() noexcept override { return now_; }
  std::int64_t steady_ns() noexcept override { return now_; }
  void sleep_until(std::int64_t monotonic_ns) noexcept override {
    while (now_ < monotonic_ns) live_through_a_moment();
    if (is_hostile() && below(500) == 0) now_ += below(5 * kTick);  // the tick is delayed
  }

  const PoseBatch* next() noexcept override {
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      auto& queue = in_flight_[i];
      if (queue.empty() || queue.front().comes > now_) continue;
      sources_[i].lied = queue.front().lies || is_dated_well_by_chance(queue.front());
      given_ = std::move(queue.front().batch);
      queue.pop_front();
      return &given_;
    }
    return nullptr;
  }

  void input(const PoseBatch&) noexcept override {}
  void statistics(const LoopStatistics&) noexcept override {}
  void report(const Report& report, std::span<const SourceUse>) noexcept override {
    for (const PairReport& pair : report.pairs) judge(report, pair);
    judge(report, report.zones[0]);
    if (++reports_ == kTicksASeed) end_faults();
    const bool all_known = std::ranges::all_of(
        report.pairs, [](const PairReport& pair) { return pair.status <= PairStatus::kCarried; });
    if (ended_ != 0 && !all_known) known_again_ = now_ - ended_;
  }

  [[nodiscard]] std::uint64_t known() const noexcept { return known_; }
  [[nodiscard]] std::uint64_t unknown() const noexcept { return unknown_; }
  [[nodiscard]] const std::string& fault() const noexcept { return fault_; }
  // How long after the last fault a pair was not certified, ns.
  [[nodiscard]] std::int64_t known_again() const noexcept { return known_again_; }

 private:
  [[nodiscard]] bool is_hostile() const noexcept { return now_ > kCalm && ended_ == 0; }
  // All clocks are right again, and nothing is lost, late or wrong any more.
  void end_faults() {
    ended_ = now_;
    wall_ahead_ = 0;
    for (TrueSource& source : sources_) {
      source.clock_ahead = 0;
      source.lost_until = source.held_up_until = source.lies_until = now_;
    }
  }
  void live_through_a_moment() {
    now_ += kTick / 4;
    if (is_hostile()) disturb();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (now_ >= sources_[i].sends_next) send(sources_[i], in_flight_[i]);
    }
  }

  // Each disturbance occurs about once in the given number of quarter milliseconds.
  void disturb() {
    if (below(40'000) == 0) wall_ahead_ += step();
    if (below(40'000) == 0) wall_ahead_ = 0;
    for (TrueSource& source : sources_) {
      if (source.elsewhere && below(40'000) == 0) source.clock_ahead += step();
      if (source.elsewhere && below(20'000) == 0) source.clock_ahead = 0;
      if (below(30'000) == 0) source.lost_until = now_ + below(2 * kOneSecond);
      if (below(30'000) == 0) source.held_up_until = now_ + below(2 * kOneSecond);
      if (below(20'000) == 0) source.sequence = 0;  // started again
      if (below(40'000) == 0) {
        source.lies_until = now_ + (below(2) == 0 ? 2 * kTick : below(kOneSecond));
        source.lie = random_.in_box(3.0);
      }
    }
  }

  std::int64_t below(std::int64_t end) {
    return static_cast<std::int64_t>(random_.next() % static_cast<std::uint64_t>(end));
  }

  // A step from a millisecond to an hour, in either direction.
  std::int64_t step() {
    const double size = std::pow(10.0, 6.0 + 6.5 * random_.unit());
    return static_cast<std::int64_t>(below(2) == 0 ? size : -size);
  }

  void send(TrueSource& source, std::deque<BatchInFlight>& queue) {
    source.sends_next = now_ + kTick + below(3 * kTick);
    ++source.sequence;
    if (now_ < source.lost_until) return;
    const std::int64_t ahead = source.elsewhere ? source.clock_ahead : wall_ahead_;
    const bool lies = now_ < source.lies_until;
    const Vec3 off = lies ? source.lie : Vec3::Zero();
    PoseSample sample = test::sample(source.object, Pose{true_position(source.object, now_) + off},
                                     kStart + now_ + ahead);
    // Batches arrive in the order of sending, as DDS delivers one writer's samples.
    source.comes_last = std::max(
        {source.comes_last, source.held_up_until, now_ + below(is_hostile() ? 3 * kTick : kTick)});
    queue.push_back({source.comes_last,
                     {.source = SourceName(source.name),
                      .sequence_number = source.sequence,
                      .samples = {sample}},
                     lies,
                     now_,
                     source.elsewhere ? source.clock_ahead : 0});
  }

  void judge(const Report& report, const PairReport& pair) {
    const bool claims = pair.status != PairStatus::kUnknown;
    ++(claims ? known_ : unknown_);
    const ObjectPair& objects = scene_.pairs[pair.pair];
    if (!claims || is_told_a_lie(objects)) return;
    const double apart = true_distance(objects);
    if (apart < pair.lower - allowed(objects) || apart > pair.upper + allowed(objects)) {
      note_fault(report, pair.pair, apart,
                 "bounds " + std::to_string(pair.lower) + " to " + std::to_string(pair.upper));
    }
  }

  void judge(const Report& report, const ZoneReport& zone) {
    if (zone.active) return;
    for (const std::uint32_t pair : scene_.zones[0].pairs) {
      const ObjectPair& objects = scene_.pairs[pair];
      const double apart = true_distance(objects);
      if (!is_told_a_lie(objects) && apart < scene_.zones[0].enter_below - allowed(objects)) {
        note_fault(report, pair, apart, "the zone is not active");
      }
    }
  }

  // The batch is from a machine whose clock is ahead, and is late by about as much, so its stamp
  // does not show the delay.
  bool is_dated_well_by_chance(const BatchInFlight& batch) const {
    return batch.clock_ahead > 0 && batch.made + batch.clock_ahead <= now_ + scene_.future_limit_ns;
  }

  void note_fault(const Report& report, std::uint32_t pair, double apart, const std::string& what) {
    if (!fault_.empty()) return;
    fault_ = "tick " + std::to_string(report.cycle) + ", pair " + std::to_string(pair) + ": true " +
             std::to_string(apart) + " m, " + what + ", clock offset " +
             std::to_string(report.clock_offset_ns);
  }

  // The last pose from one of the sources was wrong, and nothing has contradicted it yet.
  bool is_told_a_lie(const ObjectPair& pair) const {
    return std::ranges::any_of(sources_, [&](const TrueSource& source) {
      return source.lied && (source.object == pair.first || source.object == pair.second);
    });
  }

  double true_distance(const ObjectPair& pair) const {
    return (place(pair.first) - place(pair.second)).norm() - 2.0 * kRadius;
  }

  Vec3 place(std::uint32_t object) const {
    const Object& body = scene_.objects[object];
    return body.fixed ? body.world_from_object.position : true_position(object, now_);
  }

  // The distance that both objects can move within the age limit and the tolerance of future
  // stamps, m.
  double allowed(const ObjectPair& pair) const {
    double distance = 0.0;
    for (const std::uint32_t object : {pair.first, pair.second}) {
      const Object& body = scene_.objects[object];
      if (body.fixed) continue;
      distance +=
          2.0 * 1e-9 * static_cast<double>(body.age_limit_ns + scene_.future_limit_ns + kTick);
    }
    return distance;
  }

  const Scene& scene_;
  Random random_;
  std::vector<TrueSource> sources_;
  std::array<std::deque<BatchInFlight>, 4> in_flight_;
  PoseBatch given_;
  std::int64_t now_ = 0, wall_ahead_ = 0;
  std::int64_t ended_ = 0, known_again_ = 0;  // 0: the faults have not ended
  std::int64_t reports_ = 0;
  std::uint64_t known_ = 0, unknown_ = 0;
  std::string fault_;
};

Scene two_movers_and_a_post() {
  Scene scene = test::cell_of({test::moving("a", {test::ball(kRadius)}),
                               test::moving("b", {test::ball(kRadius)}),
                               test::fixed("post", {test::ball(kRadius)}, test::at(0, 0, 1))});
  scene.objects[0].may_jump = scene.objects[1].may_jump = false;
  scene.objects[0].max_speed = 2.0;
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.zones = {test::zone_over(scene, 1.5, 1.6)};
  return scene;
}

class HostileInputs : public testing::TestWithParam<std::uint32_t> {};

TEST_P(HostileInputs, MakeNoBoundFalseAndNoZoneLeftAndAllIsKnownAfterwards) {
  const Scene scene = two_movers_and_a_post();
  HostileWorld world(scene, GetParam());
  TickLoop loop(scene, world, {&world}, world, {.max_ticks = kTicksASeed + kTicksAfter});
  const std::atomic<bool> stop{false};
  loop.run(stop);
  EXPECT_EQ(world.fault(), "");
  EXPECT_GT(world.known(), world.unknown() / 4) << "the daemon still says something";
  EXPECT_GT(world.unknown(), 1000u) << "the inputs are hostile";
  EXPECT_LE(world.known_again(), kKnownAgain);
}

INSTANTIATE_TEST_SUITE_P(Seeds, HostileInputs, testing::Range(1u, 41u));

}  // namespace
}  // namespace clearance
