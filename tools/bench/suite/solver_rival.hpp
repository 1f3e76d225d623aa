// A solver of tools/bench/measure.hpp as a rival of the suite.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "tools/bench/measure.hpp"
#include "tools/bench/suite/rival.hpp"

namespace clearance::bench {

template <class Solver>
class SolverPair final : public RivalPair {
 public:
  SolverPair(const ConvexBody& a, const ConvexBody& b)
      : a_(Solver::shape(a)), b_(Solver::shape(b)), solver_(a_, b_) {}
  void forget() override { solver_.forget(); }
  double distance(const PlainPose& a, const PlainPose& b) override {
    const Answer answer = solver_.query(*a.pose, *b.pose);
    return answer.ok ? answer.distance : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  typename Solver::Shape a_, b_;
  Solver solver_;
};

template <class Solver>
Rival solver_rival(std::string name, std::string setting, bool has_depth) {
  return {std::move(name), std::move(setting), has_depth,
          [](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
            return std::make_unique<SolverPair<Solver>>(*a.body, *b.body);
          }};
}

}  // namespace clearance::bench
