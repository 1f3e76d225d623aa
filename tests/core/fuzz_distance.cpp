// Fuzz target (libFuzzer) of the shape factories, distance() and DistanceBatch.
//
// Oracles: the exact rational distance of tests/shared/exact_oracle.hpp, through
// tests/shared/distance_judge.hpp; single queries, bit by bit, for the batch; and the sanitizers.
// The input selects a hard case by family and seed, and then changes some of its doubles. Doubles
// change to neighbours, to zero, or to other doubles of the case. The query is asked with a state
// that the input makes up, with the resulting state after B has moved, and without the depth.
//
// The build takes a quarter of an hour on one core. To build and run (Debian: apt-get install clang
// libclang-rt-14-dev):
//
//   CXX=clang++ CC=clang cmake -B build-fuzz -G Ninja -DCLEARANCE_FUZZ=ON -DCLEARANCE_CORE_ONLY=ON
//   ninja -C build-fuzz fuzz_distance
//   build-fuzz/bin/fuzz_distance -max_len=96 -max_total_time=600
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/batch.hpp"
#include "core/distance.hpp"
#include "tests/core/fuzz_input.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/nonsense_state.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

std::vector<double*> doubles_of(hard::HardCase& c) {
  std::vector<double*> out;
  for (hard::Body* body : {&c.a, &c.b}) {
    for (HalfSpace& row : body->rows) {
      for (int k = 0; k < 3; ++k) out.push_back(&row.normal[k]);
      out.push_back(&row.offset);
    }
    for (Vec3& point : body->points) {
      for (int k = 0; k < 3; ++k) out.push_back(&point[k]);
    }
    out.push_back(&body->radius);
  }
  append_numbers(c.pose_a, out);
  append_numbers(c.pose_b, out);
  return out;
}

TrackingState::Side any_side(Bytes& bytes) {
  TrackingState::Side out;
  out.kind = static_cast<FeatureKind>(bytes.byte() % 8);
  out.feature = bytes.byte() % 64 - 2;
  out.point = {bytes.byte() / 64.0 - 2.0, bytes.byte() / 64.0 - 2.0, bytes.byte() / 64.0 - 2.0};
  out.point *= std::ldexp(1.0, bytes.byte() % 64);
  return out;
}

// Empty bodies, invalid radii and zero quaternions have no true distance to compare with.
bool has_truth(const hard::HardCase& c) {
  const auto is_radius = [](double r) { return r >= 0.0 && r <= kLargestCoordinate; };
  if (!is_radius(c.a.radius) || !is_radius(c.b.radius)) return false;
  if (c.pose_a.orientation.norm() == 0.0 || c.pose_b.orientation.norm() == 0.0) return false;
  try {
    oracle::ExactBody a(c.a), b(c.b);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

class Fuzzed {
 public:
  Fuzzed(const char* family, const hard::HardCase& c) : family_(family), c_(c), judge_(c.a, c.b) {}

  [[nodiscard]] bool refused() const { return !judge_.refusal().empty(); }
  [[nodiscard]] const DistanceJudge& judge() const { return judge_; }

  // `state` may be any state.
  void ask(TrackingState& state) {
    const DistanceResult result = judge_.ask(c_.pose_a, c_.pose_b, state);
    const oracle::ExactDistance truth = judge_.truth(c_.pose_a, c_.pose_b);
    const auto faults = judge_.faults(result, truth, c_.pose_a, c_.pose_b);
    for (const std::string& fault : faults) std::fprintf(stderr, "%s\n", fault.c_str());
    if (!faults.empty()) fail();
    if (!truth.cores_meet()) ask_without_depth(truth);
  }

  void move(Random& random) {
    const double reach = judge_.a().bounding_radius + judge_.b().bounding_radius;
    const double step = random.log_uniform(1e-16, 1.0);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(step, random.direction()));
    c_.pose_b.position += random.in_box(step * reach);
    if (random.chance(0.7)) c_.pose_b.orientation = turn * c_.pose_b.orientation;
  }

  // Asks twice at the same poses, so that the second round uses vector code, and once after B has
  // moved.
  void follow_in_batch(Random& random) {
    const ConvexBody* const bodies[] = {&judge_.a(), &judge_.b()};
    const BodyPair pairs[] = {{0, 1}, {1, 0}};
    DistanceBatch batch(bodies, pairs);
    TrackingState states[2];
    for (int round = 0; round < 4; ++round) {
      if (round == 2) move(random);
      const Pose poses[] = {c_.pose_a, c_.pose_b};
      const auto answers = batch.evaluate(poses);
      for (std::size_t i = 0; i < 2; ++i) {
        const auto [a, b] = pairs[i];
        const DistanceResult expected =
            distance(*bodies[a], *bodies[b], poses[a], poses[b], states[i]);
        if (same_bits(answers[i], expected)) continue;
        std::fprintf(stderr, "batch: round %d, pair %zu: %.17g, not %.17g\n", round, i,
                     answers[i].distance, expected.distance);
        fail();
      }
    }
  }

 private:
  void ask_without_depth(const oracle::ExactDistance& truth) {
    TrackingState state;
    const DistanceResult r = distance(judge_.a(), judge_.b(), relative_pose(c_.pose_a, c_.pose_b),
                                      state, {.depth = false});
    if (truth.compare(r.lower) >= 0 && truth.compare(r.upper) <= 0) return;
    std::fprintf(stderr, "without depth: [%.17g, %.17g]\n", r.lower, r.upper);
    fail();
  }

  [[noreturn]] void fail() const {
    std::fprintf(stderr, "%s\n", hard::json_line("fuzz", family_, c_).c_str());
    std::abort();
  }

  const char* family_;
  hard::HardCase c_;
  DistanceJudge judge_;
};

void run(Bytes bytes) {
  const auto families = hard::case_families();
  const hard::CaseFamily& family = families[bytes.byte() % families.size()];
  Random random(bytes.word());
  hard::HardCase c = family.make(random);
  const std::uint8_t how = bytes.byte();
  const bool by_input = how % 2 == 1, at_random = how % 4 == 2, moves = how >= 128;
  TrackingState state;
  if (by_input) state = {any_side(bytes), any_side(bytes)};
  state.a.penetrating = bytes.byte() % 2 == 1;
  change(doubles_of(c), 32, bytes);
  if (!has_truth(c)) return;
  Fuzzed fuzzed(family.name, c);
  if (fuzzed.refused()) return;
  if (at_random) state = test::nonsense_state(fuzzed.judge().a(), fuzzed.judge().b(), random);
  fuzzed.ask(state);
  if (moves) {
    fuzzed.move(random);
    fuzzed.ask(state);
  }
  fuzzed.follow_in_batch(random);
}

}  // namespace
}  // namespace clearance

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  clearance::run(clearance::Bytes(data, size));
  return 0;
}
