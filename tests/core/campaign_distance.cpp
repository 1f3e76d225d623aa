// Long seeded campaign: distance() on every hard family. Queries are cold, tracked and swapped, and
// start from nonsense states, from any features of the bodies, and from the state of another pair.
//
// Oracle: the exact rational distance of tests/shared/exact_oracle.hpp, through
// tests/shared/distance_judge.hpp. The program prints what is wrong and writes each failing case as
// a line that clearance-distance reads.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "core/numerics/error_constants.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/nonsense_state.hpp"

namespace clearance {
namespace {

struct Tally {
  long asked = 0, failed = 0, cases = 0;
  long iterations = 0, most_iterations = 0;
  // except at the iteration limit: upper - lower, relative to DistanceJudge::size
  double widest = 0.0;
};

// Streams of neighbouring seeds differ by only one draw. No case draws as many numbers as this
// stride.
constexpr std::uint64_t kSeedStride = 100000;

class Campaign {
 public:
  explicit Campaign(const std::string& findings) : findings_(findings, std::ios::app) {}

  void run_case(const hard::CaseFamily& family, std::uint64_t seed) {
    Random random(seed);
    const hard::HardCase c = family.make(random);
    tally_ = &tallies_[family.name];
    id_ = std::string(family.name) + "-" + std::to_string(seed);
    line_ = [&] { return hard::json_line(id_, family.name, c); };
    ++tally_->cases;
    DistanceJudge judge(c.a, c.b), swapped(c.b, c.a);
    if (!judge.refusal().empty()) return report("refused: " + judge.refusal());
    const oracle::ExactDistance truth = judge.truth(c.pose_a, c.pose_b);

    TrackingState state;
    check(judge, judge.ask(c.pose_a, c.pose_b, state), truth, c.pose_a, c.pose_b, "cold");
    check(judge, judge.ask(c.pose_a, c.pose_b, state), truth, c.pose_a, c.pose_b, "again");
    for (int k = 0; k < 2; ++k) {
      state = test::nonsense_state(judge.a(), judge.b(), random);
      check(judge, judge.ask(c.pose_a, c.pose_b, state), truth, c.pose_a, c.pose_b, "nonsense");
      state = test::other_state(judge.a(), judge.b(), random);
      check(judge, judge.ask(c.pose_a, c.pose_b, state), truth, c.pose_a, c.pose_b, "elsewhere's");
    }
    check(judge, judge.ask(c.pose_a, c.pose_b, last_), truth, c.pose_a, c.pose_b, "another's");
    TrackingState other;
    check(swapped, swapped.ask(c.pose_b, c.pose_a, other), truth, c.pose_b, c.pose_a, "swapped");
    last_ = other;
  }

  void run_motion(const hard::MotionFamily& family, std::uint64_t seed, int steps) {
    Random random(seed);
    const hard::HardMotion m = family.make(random, steps);
    tally_ = &tallies_[family.name];
    id_ = std::string(family.name) + "-" + std::to_string(seed);
    line_ = [&] { return hard::json_line(id_, family.name, m); };
    ++tally_->cases;
    DistanceJudge judge(m.a, m.b);
    if (!judge.refusal().empty()) return report("refused: " + judge.refusal());
    TrackingState state;
    int step = 0;
    for (const auto& [pose_a, pose_b] : m.poses) {
      const DistanceResult result = judge.ask(pose_a, pose_b, state);
      check(judge, result, judge.truth(pose_a, pose_b), pose_a, pose_b,
            ("step " + std::to_string(step++)).c_str());
    }
  }

  // Returns true if no fault has been found.
  bool summary() const {
    long failed = 0;
    for (const auto& [name, t] : tallies_) {
      const double mean =
          static_cast<double>(t.iterations) / static_cast<double>(std::max(1L, t.asked));
      std::printf(
          "%-18s %7ld cases %8ld queries %6ld wrong, iterations mean %.2f most %ld, gap %.3g\n",
          name.c_str(), t.cases, t.asked, t.failed, mean, t.most_iterations, t.widest);
      failed += t.failed;
    }
    return failed == 0;
  }

 private:
  void check(DistanceJudge& judge, const DistanceResult& result, const oracle::ExactDistance& truth,
             const Pose& pose_a, const Pose& pose_b, const char* how) {
    ++tally_->asked;
    tally_->iterations += result.iterations;
    tally_->most_iterations = std::max<long>(tally_->most_iterations, result.iterations);
    const double gap = result.upper - result.lower - 4.0 * kUnderflow;
    const double size = judge.size(result, truth, pose_a, pose_b);
    if (result.status != DistanceStatus::kIterationLimit && gap < kInfinity && size > 0.0) {
      tally_->widest = std::max(tally_->widest, gap / size);
    }
    for (const std::string& fault : judge.faults(result, truth, pose_a, pose_b)) {
      report(std::string(how) + ": " + fault);
    }
  }

  void report(const std::string& what) {
    ++tally_->failed;
    std::printf("%s %s\n", id_.c_str(), what.c_str());
    if (id_ != last_written_) findings_ << line_() << std::endl;
    last_written_ = id_;
  }

  std::ofstream findings_;
  std::map<std::string, Tally> tallies_;
  Tally* tally_ = nullptr;
  TrackingState last_;  // state of the previous pair
  std::string id_, last_written_;
  std::function<std::string()> line_;
};

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: campaign_distance FIRST_SEED CASES MOTIONS [FINDINGS.jsonl] [FAMILY]\n"
                 "CASES single poses and MOTIONS motions of 100 poses of each family, with seeds\n"
                 "FIRST_SEED, FIRST_SEED + 100000, ...; prints what is wrong, and by family the\n"
                 "widest bounds (upper - lower) over what errors are relative to.\n"
                 "example: campaign_distance 0 1000 10 findings.jsonl\n";
    return 2;
  }
  const std::uint64_t first = std::strtoull(argv[1], nullptr, 10);
  const std::uint64_t cases = std::strtoull(argv[2], nullptr, 10),
                      motions = std::strtoull(argv[3], nullptr, 10);
  const std::string only = argc > 5 ? argv[5] : "";
  clearance::Campaign campaign(argc > 4 ? argv[4] : "findings.jsonl");
  for (const auto& family : clearance::hard::case_families()) {
    if (!only.empty() && only != family.name) continue;
    for (std::uint64_t k = 0; k < cases; ++k)
      campaign.run_case(family, first + k * clearance::kSeedStride);
  }
  for (const auto& family : clearance::hard::motion_families()) {
    if (!only.empty() && only != family.name) continue;
    for (std::uint64_t k = 0; k < motions; ++k)
      campaign.run_motion(family, first + k * clearance::kSeedStride, 100);
  }
  return campaign.summary() ? 0 : 1;
}
