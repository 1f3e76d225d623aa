// Fuzz target (libFuzzer) of the shape factories and distance().
//
// Oracle: the exact rational distance of tests/shared/exact_oracle.hpp, through
// tests/shared/distance_judge.hpp; and the sanitizers. The input picks a hard case by family and
// seed and then changes doubles of it: to neighbours, to zero, to other doubles of the same case.
//
// To build and to run it:
//
//   CXX=clang++ CC=clang cmake -B build-fuzz -G Ninja -DCLEARANCE_FUZZ=ON -DCLEARANCE_CORE_ONLY=ON
//   ninja -C build-fuzz fuzz_distance
//   build-fuzz/bin/fuzz_distance -max_len=96 -max_total_time=600
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"

namespace clearance {
namespace {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool any_left() const { return at_ < size_; }
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  std::uint32_t word() {
    const std::uint32_t low = byte(), high = byte();
    return low | high << 8;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

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
  }
  for (Pose* pose : {&c.pose_a, &c.pose_b}) {
    for (int k = 0; k < 3; ++k) out.push_back(&pose->position[k]);
    for (int k = 0; k < 4; ++k) out.push_back(&pose->orientation.coeffs()[k]);
  }
  return out;
}

void change(hard::HardCase& c, Bytes& bytes) {
  const std::vector<double*> doubles = doubles_of(c);
  while (bytes.any_left()) {
    double& x = *doubles[bytes.word() % doubles.size()];
    const std::uint8_t how = bytes.byte();
    switch (how % 6) {
      case 0:
        x = std::nextafter(x, how < 128 ? -kInfinity : kInfinity);
        break;
      case 1:
        x = 0.0;
        break;
      case 2:
        x = -x;
        break;
      case 3:
        x = *doubles[bytes.word() % doubles.size()];
        break;
      case 4:
        x = std::ldexp(x, bytes.byte() % 64 - 32);
        break;
      default:
        x += (how - 128) * std::ldexp(1.0, -bytes.byte() % 64);
    }
  }
}

TrackingState::Side any_side(Bytes& bytes) {
  TrackingState::Side out;
  out.dimension = bytes.byte() % 8;
  out.feature = bytes.byte() % 64 - 2;
  out.point = {bytes.byte() / 64.0 - 2.0, bytes.byte() / 64.0 - 2.0, bytes.byte() / 64.0 - 2.0};
  out.point *= std::ldexp(1.0, bytes.byte() % 64);
  return out;
}

// Empty bodies and zero quaternions have no truth to be held against.
bool has_truth(const hard::HardCase& c) {
  if (c.pose_a.orientation.norm() == 0.0 || c.pose_b.orientation.norm() == 0.0) return false;
  try {
    oracle::ExactBody a(c.a), b(c.b);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

void run(Bytes bytes) {
  const auto families = hard::case_families();
  const hard::CaseFamily& family = families[bytes.byte() % families.size()];
  Random random(bytes.word());
  hard::HardCase c = family.make(random);
  TrackingState state;
  if (bytes.byte() % 2 == 1) state = {any_side(bytes), any_side(bytes)};
  state.a.deep = bytes.byte() % 2 == 1;
  change(c, bytes);
  if (!has_truth(c)) return;
  DistanceJudge judge(c.a, c.b);
  if (!judge.refusal().empty()) return;
  const DistanceResult result = judge.ask(c.pose_a, c.pose_b, state);
  const auto faults = judge.faults(result, judge.truth(c.pose_a, c.pose_b), c.pose_a, c.pose_b);
  if (faults.empty()) return;
  for (const std::string& fault : faults) std::fprintf(stderr, "%s\n", fault.c_str());
  std::fprintf(stderr, "%s\n", hard::json_line("fuzz", family.name, c).c_str());
  std::abort();
}

}  // namespace
}  // namespace clearance

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  clearance::run(clearance::Bytes(data, size));
  return 0;
}
