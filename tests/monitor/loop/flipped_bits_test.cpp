// Bits that flip in the memory of one of two daemons that tick the same.
//
// Oracle: the other daemon. A trial runs in a process of its own, since an index with another bit
// may end the daemon: then its partner is the one that goes on.
//
// The campaign: CLEARANCE_FLIPS=1000 daemon_tests --gtest_filter='FlippedBits.*'
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "monitor/tick/monitor_state.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/random.hpp"

namespace clearance {

// A value in the memory of a monitor, and the number of its bits that may flip.
struct FlippableField {
  std::string name;
  unsigned bits = 0;
  std::function<void(unsigned bit)> flip = {};
};

// Reaches into a monitor.
class MonitorMemory {
 public:
  explicit MonitorMemory(Monitor& monitor) : state_(*monitor.state_) {}

  // Every value of the pair table, but the hints from which queries start.
  std::vector<FlippableField> pair_table() {
    fields_.clear();
    PairTable& table = state_.table;
    for (std::uint32_t pair = 0; pair < table.pairs(); ++pair) {
      PairEntry& entry = table.entries[pair];
      add("object_a", entry.object_a);
      add("object_b", entry.object_b);
      add("carried_at.a", entry.carried_at.a);
      add("carried_at.b", entry.carried_at.b);
      add("carried_cycle", entry.carried_cycle);
      add("least_lower", entry.least_lower);
      add("lower_before", entry.lower_before);
      add("evaluated_cycle", entry.evaluated_cycle);
      add("refreshed_cycle", entry.refreshed_cycle);
    }
    for (std::uint32_t i = 0; i < table.part_pairs(); ++i) {
      add("lower", table.lower[i]);
      add("upper", table.upper[i]);
      Evaluations& evaluations = table.evaluations;
      fields_.push_back({"evaluation cycle", 64, [&evaluations, i](unsigned bit) {
                           evaluations.set_cycle(i, evaluations.cycle(i) ^ std::uint64_t{1} << bit);
                         }});
      Evaluation* const evaluation = evaluations.find(i);
      if (evaluation == nullptr) continue;
      add("gap", evaluation->gap);
      add("lower_between", evaluation->lower_between);
      add("closest.distance", evaluation->closest.distance);
      add("closest.lower", evaluation->closest.lower);
      add("witness_a", evaluation->closest.witness_a);
      add("witness_b", evaluation->closest.witness_b);
      add("normal", evaluation->closest.normal);
      // Other bits of it make no value of the type.
      add("status", reinterpret_cast<std::uint8_t&>(evaluation->status), 2);
    }
    return std::move(fields_);
  }

  // Every value of the poses of objects and parts, but what is kept to judge the next sample.
  std::vector<FlippableField> pose_table() {
    fields_.clear();
    for (TrackedObject& object : state_.inputs.objects) add(object);
    for (PosedPart& part : state_.parts) add(part);
    return std::move(fields_);
  }

  // The checksums of all slices.
  std::vector<std::uint64_t> checksums(const Monitor& monitor) {
    std::vector<std::uint64_t> sums;
    const std::uint64_t cycle = state_.inputs.cycle;
    for (std::uint64_t slice = 0; slice < Monitor::kStateSlices; ++slice) {
      state_.inputs.cycle = cycle + slice;
      sums.push_back(monitor.checksum());
    }
    state_.inputs.cycle = cycle;
    return sums;
  }

 private:
  void add(TrackedObject& object) {
    add("moved", object.moved);
    add("newly_known", object.newly_known);
    add("discontinuous", object.discontinuous);
    add("plain", object.plain);
    add("absent", object.absent);
    add("may_have_moved", object.may_have_moved);
    add("unobserved", object.unobserved);
    add("displacement", object.displacement);
    add("accumulated_last_tick", object.accumulated_last_tick);
    add("accumulated", object.accumulated);
    add("bend", object.bend);
    add("accumulated_turn", object.accumulated_turn);
    add("bounding_radius", object.bounding_radius);
    add("pose", object.pose);
    add("rest.holds", object.rest.holds);
    add("rest.has_twist", object.rest.has_twist);
    add("rest.until_ns", object.rest.until_ns);
    add("has_value", object.input.has_value);
    add("late", object.input.late);
    add("contradicted", object.input.contradicted);
    add("ages", object.input.ages);
    add("stamp_ns", object.input.stamp_ns);
    add("twist.linear", object.twist.linear);
    add("twist.angular", object.twist.angular);
    add("motion.shift", object.motion.shift);
    add("motion.turn", object.motion.turn);
    add("twist_known", object.twist_known);
    add("follows_joints", object.follows_joints);
    add("joints_late", object.joints_late);
    add("joints_contradicted", object.joints_contradicted);
    add("unobserved_by_joints", object.unobserved_by_joints);
    add("pose_last_tick", object.pose_last_tick);
    add("pose_before", object.pose_before);
    add("pose_last_tick_known", object.pose_last_tick_known);
  }
  void add(PosedPart& part) {
    add("part.object", part.object);
    add("part.index_in_object", part.index_in_object);
    add("placed", part.placed);
    add("sphere_in_world", part.sphere_in_world);
    add("world_from_part", part.world_from_part);
    add("shift_error", part.shift_error);
    add("turn_error", part.turn_error);
    add("turning", part.turning);
    add("coordinates", part.coordinates);
    for (int i = 0; i < 9; ++i) add("rotation", part.world_from_part_rotation.data()[i]);
    add("object_from_part", part.object_from_part);
    add("part.bounding_radius", part.bounding_radius);
    add("extent", part.extent);
    add("sphere_in_part", part.sphere_in_part);
    add("offset_length", part.offset_length);
    add("sphere_offset", part.sphere_offset);
    add("keeps_direction", part.keeps_direction);
  }
  template <class T>
  requires(std::is_arithmetic_v<T>) void add(const char* name, T& value, unsigned bits = 0) {
    constexpr unsigned kAll = std::is_same_v<T, bool> ? 1 : 8 * sizeof(T);
    fields_.push_back({name, bits == 0 ? kAll : bits, [&value](unsigned bit) {
                         if constexpr (std::is_same_v<T, bool>) {
                           value = !value;
                         } else if constexpr (std::is_same_v<T, double>) {
                           value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^
                                                         std::uint64_t{1} << bit);
                         } else {
                           value = static_cast<T>(value ^ T{1} << bit);
                         }
                       }});
  }
  void add(const char* name, Vec3& value) {
    for (double& each : value) add(name, each);
  }
  void add(const char* name, Pose& pose) {
    add(name, pose.position);
    for (double& each : pose.orientation.coeffs()) add(name, each);
  }
  void add(const char* name, Sphere& sphere) {
    add(name, sphere.centre);
    add(name, sphere.radius);
  }

  Monitor::State& state_;
  std::vector<FlippableField> fields_;
};

namespace {

using test::kTick;

enum class Outcome { kMasked, kFound, kLate, kEnded };

// Two monitors that get the same samples. All pairs are published, and only two of them are
// evaluated in a tick.
class FlippedBits : public testing::Test {
 protected:
  void SetUp() override {
    std::vector<Object> objects;
    for (const char* name : {"a", "b", "c", "d"}) {
      objects.push_back(test::moving(name, {test::ball(0.1), test::capsule(0.4, 0.05)}));
      objects.back().max_speed = 5.0;
    }
    scene = test::cell_of(std::move(objects));
    scene.rate_hz = 1000;
    for (ObjectPair& pair : scene.pairs) pair.publish = true;
    scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
    scene.budget = 2;
    one = std::make_unique<Monitor>(scene);
    other = std::make_unique<Monitor>(scene);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(tick());
  }
  // True if both have the same bits.
  bool tick() {
    ++number;
    std::vector<PoseSample> samples;
    const double t = 0.001 * static_cast<double>(number);
    const std::int64_t now = test::kStart + static_cast<std::int64_t>(number) * kTick;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec3 place(0.6 * i + 0.3 * std::sin(7 * t + i), 0.2 * t, 0);
      const Eigen::AngleAxisd turn(0.3 * std::sin(5 * t + i), Vec3::UnitZ());
      samples.push_back(test::sample(i, {place, Eigen::Quaterniond(turn)}, now));
    }
    const auto sums = [&](Monitor& monitor) {
      const Report& report = monitor.tick(samples, now);
      return std::pair(checksum_of(report), checksum_of_rest(report, monitor.checksum()));
    };
    return sums(*one) == sums(*other);
  }
  Outcome outcome_of(const std::function<void()>& flip) {
    flip();
    for (int i = 0; i < 10; ++i) {
      if (!tick()) return Outcome::kFound;
    }
    for (int i = 0; i < 100; ++i) {
      if (!tick()) return Outcome::kLate;
    }
    return Outcome::kMasked;
  }
  // The same in a process of its own, which may crash, hang or give up.
  Outcome outcome_elsewhere(const std::function<void()>& flip) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(99);
      for (const int number_of_signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE})
        std::signal(number_of_signal, SIG_DFL);
      alarm(10);
      _exit(static_cast<int>(outcome_of(flip)));
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    const bool has_outcome = WIFEXITED(status) && WEXITSTATUS(status) <= 2;
    return has_outcome ? static_cast<Outcome>(WEXITSTATUS(status)) : Outcome::kEnded;
  }

  Scene scene;
  std::unique_ptr<Monitor> one, other;
  std::uint64_t number = 0;
};

// A flip that stays where it is for eight ticks is found, whatever reads it.
TEST_F(FlippedBits, OfEveryFieldChangeTheChecksumOfATickOutOfEight) {
  MonitorMemory memory(*one);
  const auto before = memory.checksums(*one);
  std::vector<FlippableField> fields = memory.pair_table();
  for (FlippableField& field : memory.pose_table()) fields.push_back(std::move(field));
  for (const FlippableField& field : fields) {
    for (const unsigned bit : {0u, field.bits / 2, field.bits - 1}) {
      field.flip(bit);
      EXPECT_NE(memory.checksums(*one), before) << field.name << ", bit " << bit;
      field.flip(bit);
    }
  }
  EXPECT_EQ(memory.checksums(*one), before);
}

// A flip that is overwritten before anything has read it is masked: nothing of it remains in the
// next hundred ticks. What is found later than after ten ticks would be missed.
//
// Not flipped are values that are only read now and then: the hints from which queries start, which
// cannot make a bound wrong; what is kept of an input to judge its next sample (its owner,
// contradictions, plausibility); what the schedule and zones keep. A flip there is found with the
// first report or field that it changes, at whatever time that is.
TEST_F(FlippedBits, OfThePairTableAndThePoseTableAreFoundWithinTenTicksOrNothingRemainsOfThem) {
  Random random(34);
  const char* const asked = std::getenv("CLEARANCE_FLIPS");
  const int flips = asked == nullptr ? 200 : std::atoi(asked);
  std::map<Outcome, int> outcomes;
  std::map<std::string, int> late;
  for (int trial = 0; outcomes[Outcome::kFound] + outcomes[Outcome::kEnded] < flips; ++trial) {
    MonitorMemory memory(*one);
    const auto fields = trial % 2 == 0 ? memory.pair_table() : memory.pose_table();
    const FlippableField& field = fields[random.next() % fields.size()];
    const auto bit = static_cast<unsigned>(random.next() % field.bits);
    const Outcome outcome = outcome_elsewhere([&] { field.flip(bit); });
    ++outcomes[outcome];
    if (outcome == Outcome::kLate) ++late[field.name];
    ASSERT_TRUE(tick());
  }
  for (const auto& [name, count] : late) ADD_FAILURE() << name << " found late: " << count;
  EXPECT_GT(outcomes[Outcome::kFound], outcomes[Outcome::kMasked]);
  std::printf("%d flips found within ten ticks, %d ended the daemon, %d left nothing behind\n",
              outcomes[Outcome::kFound], outcomes[Outcome::kEnded], outcomes[Outcome::kMasked]);
}

}  // namespace
}  // namespace clearance
