#include "tools/bench/suite/race.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "tools/bench/clocks.hpp"
#include "tools/bench/suite/plain_body.hpp"

namespace clearance::bench {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using PlainPoses = std::vector<std::pair<PlainPose, PlainPose>>;

// One rival on one case.
class Lane {
 public:
  Lane(std::unique_ptr<RivalPair> pair, std::size_t steps) : pair_(std::move(pair)) {
    for (Timed* timed : {&tracked, &cold}) {
      timed->ns.assign(steps, kInfinity);
      timed->answer.resize(steps);
    }
  }

  void run(const PlainPoses& poses, double clock_ns) {
    follow(poses, clock_ns, false, tracked);
    follow(poses, clock_ns, true, cold);
    pair_->forget();
    double sum = 0.0;
    const double start = wall_ns();
    for (const auto& [a, b] : poses) sum += pair_->distance(a, b);
    const double ns = (wall_ns() - start - clock_ns) / static_cast<double>(poses.size());
    sink = sum;
    streamed_ns = std::min(streamed_ns, ns);
  }

  struct Timed {
    std::vector<double> ns, answer;
  };
  Timed tracked, cold;
  double streamed_ns = kInfinity;
  volatile double sink = 0.0;  // keeps the compiler from leaving the queries out

 private:
  void follow(const PlainPoses& poses, double clock_ns, bool forgets, Timed& into) {
    pair_->forget();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (forgets) pair_->forget();
      const double start = wall_ns();
      into.answer[k] = pair_->distance(poses[k].first, poses[k].second);
      into.ns[k] = std::min(into.ns[k], std::max(0.0, wall_ns() - start - clock_ns));
    }
  }

  std::unique_ptr<RivalPair> pair_;
};

// A case with its rivals' lanes; null where a rival is not asked.
struct Heat {
  SuiteCase set;
  PlainBody a, b;
  PlainPoses poses;
  std::vector<std::unique_ptr<Lane>> lanes;
};

std::unique_ptr<Heat> heat_of(SuiteCase case_set, std::span<const Rival> rivals) {
  auto heat = std::make_unique<Heat>();
  heat->set = std::move(case_set);
  const SuiteCase& set = heat->set;
  heat->a = plain_body(*set.motion.a);
  heat->b = plain_body(*set.motion.b);
  for (const auto& [a, b] : set.motion.poses) {
    heat->poses.emplace_back(plain_pose(a), plain_pose(b));
  }
  const bool overlaps = set.separation < 0.0;
  for (const Rival& rival : rivals) {
    auto pair = overlaps && !rival.has_depth ? nullptr : rival.pair(heat->a, heat->b);
    heat->lanes.push_back(pair ? std::make_unique<Lane>(std::move(pair), heat->poses.size())
                               : nullptr);
  }
  return heat;
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return kNan;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The queries of a row, as they are added up.
struct Pool {
  std::vector<double> ns, errors, streamed;
  int failures = 0;

  void add(const Heat& heat, const Lane& lane, bool cold, bool has_depth) {
    const Lane::Timed& timed = cold ? lane.cold : lane.tracked;
    for (std::size_t k = cold ? 0 : 1; k < timed.ns.size(); ++k) {
      ns.push_back(timed.ns[k]);
      const Judged judged = judge(timed.answer[k], heat.set.exact[k], heat.set.size, has_depth);
      failures += judged.failed;
      if (!std::isnan(judged.error)) errors.push_back(judged.error);
    }
    if (!cold) streamed.push_back(lane.streamed_ns);
  }

  [[nodiscard]] RaceRow row(const std::string& kind, double separation, std::size_t rival,
                            bool cold) {
    const int queries = static_cast<int>(ns.size());
    return {kind,
            separation,
            rival,
            cold,
            quantile(ns, 0.5),
            quantile(ns, 0.9),
            quantile(streamed, 0.5),
            quantile(errors, 0.5),
            quantile(errors, 1.0),
            failures,
            queries};
  }
};

void add_rows(const std::string& kind, const std::vector<std::unique_ptr<Heat>>& heats,
              std::span<const Rival> rivals, std::vector<RaceRow>& rows) {
  for (std::size_t r = 0; r < rivals.size(); ++r) {
    for (const bool cold : {false, true}) {
      Pool all;
      std::map<double, Pool> by_separation;
      for (const auto& heat : heats) {
        if (heat->set.kind != kind || !heat->lanes[r]) continue;
        all.add(*heat, *heat->lanes[r], cold, rivals[r].has_depth);
        by_separation[heat->set.separation].add(*heat, *heat->lanes[r], cold, rivals[r].has_depth);
      }
      if (all.ns.empty()) continue;
      rows.push_back(all.row(kind, kNan, r, cold));
      for (auto& [separation, pool] : by_separation) {
        rows.push_back(pool.row(kind, separation, r, cold));
      }
    }
  }
}

}  // namespace

Judged judge(double answer, double exact, double size, bool has_depth) {
  const double allowed = kSuiteFailure * (size + std::abs(exact));
  if (std::isnan(answer)) return {kNan, true};
  if (answer == kInfinity) return {kNan, exact < -allowed};
  const double said = has_depth ? answer : std::max(0.0, answer);
  const double error = std::abs(said - exact);
  return {error, !(error <= allowed)};
}

std::vector<RaceRow> race(
    std::span<const Rival> rivals, std::span<const std::string> kinds, const RaceOptions& options,
    const std::function<void(double share, const std::string& what)>& progress) {
  std::vector<std::unique_ptr<Heat>> heats;
  for (const std::string& kind : kinds) {
    progress(0.0, "making the cases: " + kind);
    for (SuiteCase& set : suite_cases(kind, options.motions, options.steps)) {
      heats.push_back(heat_of(std::move(set), rivals));
    }
  }
  const double clock_ns = cost_of(wall_ns);
  const std::size_t all = static_cast<std::size_t>(options.passes) * heats.size();
  std::size_t done = 0;
  for (int pass = 0; pass < options.passes; ++pass) {
    for (const auto& heat : heats) {
      // Each rival comes first in its turn, when the caches are those of another case.
      for (std::size_t i = 0; i < rivals.size(); ++i) {
        Lane* const lane = heat->lanes[(i + done) % rivals.size()].get();
        if (lane != nullptr) lane->run(heat->poses, clock_ns);
      }
      if (++done % 16 == 0) {
        progress(static_cast<double>(done) / static_cast<double>(all), heat->set.kind);
      }
    }
  }
  std::vector<RaceRow> rows;
  for (const std::string& kind : kinds) add_rows(kind, heats, rivals, rows);
  return rows;
}

}  // namespace clearance::bench
