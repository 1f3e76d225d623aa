// Fuzz target (libFuzzer) of distance() of curved bodies.
//
// Oracle: 50 digits of tests/shared/curved_oracle.hpp, through tests/shared/curved_judge.hpp; and
// the sanitizers. The input selects a hard case by family and seed, and then changes some of its
// numbers. Numbers change to neighbouring doubles, to other numbers of the case, by powers of two,
// or by a little. The query is asked cold, with a state that the input makes up, and with the
// resulting state after B has moved.
//
// To build and run (Debian: apt-get install clang libclang-rt-14-dev):
//
//   CXX=clang++ CC=clang cmake -B build/fuzz -G Ninja -DCLEARANCE_FUZZ=ON -DCLEARANCE_CORE_ONLY=ON
//   ninja -C build/fuzz fuzz_curved
//   build/fuzz/bin/fuzz_curved -max_len=64 -max_total_time=3600
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "tests/core/fuzz_input.hpp"
#include "tests/shared/curved_judge.hpp"
#include "tests/shared/nonsense_state.hpp"

namespace clearance {
namespace {

using hard::CurvedCase;

std::vector<double*> numbers_of(CurvedCase& c) {
  std::vector<double*> out;
  for (oracle::CurvedBody* body : {&c.a, &c.b}) {
    for (Vec3& p : body->points) out.insert(out.end(), {&p.x(), &p.y(), &p.z()});
    for (int k = 0; k < 3; ++k) out.push_back(&body->shape.semi_axes[k]);
    for (Disc& disc : body->shape.discs) out.push_back(&disc.radius);
    out.push_back(&body->radius);
  }
  append_numbers(c.pose_a, out);
  append_numbers(c.pose_b, out);
  return out;
}

void change(CurvedCase& c, Bytes& bytes) {
  change(numbers_of(c), 12, bytes);
  for (Pose* pose : {&c.pose_a, &c.pose_b}) {
    const double norm = pose->orientation.norm();
    if (norm > 1e-3) pose->orientation.coeffs() /= norm;
  }
}

// Returns true if the bodies are valid and 50 digits are enough for them.
bool has_truth(CurvedCase& c) {
  for (const double* x : numbers_of(c)) {
    if (!(std::abs(*x) < 1e6)) return false;
  }
  for (oracle::CurvedBody* body : {&c.a, &c.b}) {
    if (!(body->radius >= 0.0)) return false;
    if (body->shape.kind == CurvedShape::Kind::kEllipsoid &&
        !(body->shape.semi_axes.minCoeff() > 1e-9)) {
      return false;
    }
  }
  return is_unit(c.pose_a.orientation) && is_unit(c.pose_b.orientation);
}

void judge(const CurvedJudge& judge, const DistanceResult& r, const char* how, const char* family,
           const CurvedCase& c) {
  const std::vector<std::string> faults = judge.faults(r);
  if (faults.empty()) return;
  for (const std::string& fault : faults) std::fprintf(stderr, "%s: %s\n", how, fault.c_str());
  CurvedCase shown = c;
  std::fprintf(stderr, "family %s, status %s, numbers", family, name(r.status));
  for (const double* x : numbers_of(shown)) std::fprintf(stderr, " %.17g", *x);
  std::fprintf(stderr, "\n");
  std::abort();
}

void run(Bytes bytes) {
  const auto families = hard::curved_families();
  const hard::CurvedFamily& family = families[bytes.byte() % families.size()];
  const std::uint64_t low = bytes.byte(), high = bytes.byte();
  Random random((high << 8 | low) * 100000);
  const std::uint8_t how = bytes.byte();
  CurvedCase c = family.make(random);
  change(c, bytes);
  if (!has_truth(c)) return;
  const ShapeResult made_a = hard::curved_model(c.a), made_b = hard::curved_model(c.b);
  const auto* a = std::get_if<ConvexBody>(&made_a);
  const auto* b = std::get_if<ConvexBody>(&made_b);
  if (a == nullptr || b == nullptr) return;
  const CurvedJudge here(c);
  TrackingState state;
  judge(here, distance(*a, *b, c.pose_a, c.pose_b, state), "cold", family.name, c);
  if (how % 2 == 1) {
    state = test::nonsense_state(*a, *b, random);
    state.a.kind = FeatureKind::kDirection;
    judge(here, distance(*a, *b, c.pose_a, c.pose_b, state), "any state", family.name, c);
  }
  if (how % 4 < 2) return;
  const double step = random.log_uniform(1e-16, 0.1) * here.size();
  c.pose_b.position += random.in_box(step);
  judge(CurvedJudge(c), distance(*a, *b, c.pose_a, c.pose_b, state), "moved", family.name, c);
}

}  // namespace
}  // namespace clearance

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  clearance::run(clearance::Bytes(data, size));
  return 0;
}
