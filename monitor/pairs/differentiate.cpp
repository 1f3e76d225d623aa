#include "monitor/pairs/differentiate.hpp"

#include <algorithm>
#include <limits>

#include "monitor/bodies/fixed_order.hpp"
#include "monitor/pairs/alternatives.hpp"

namespace clearance {
namespace {

// Distance, witness points and normal are of this tick. An image without elements has no normal.
bool has_normal(const PairReport& pair) noexcept {
  return pair.status <= PairStatus::kIterationLimit && pair.normal.allFinite();
}

}  // namespace

Differentiation::Differentiation(const Scene& scene) : scene_(scene), rows_(gradient_rows(scene)) {
  std::vector<const ObjectPair*> published;
  for (const ObjectPair& pair : scene.pairs) {
    if (pair.publish) published.push_back(&pair);
  }
  std::size_t most_terms = 0;
  for (const GradientRow& row : rows_.rows) {
    add_terms(row, *published[row.published]);
    most_terms = std::max<std::size_t>(most_terms, terms_of_.back().end - terms_of_.back().first);
  }
  turns_.reserve(most_terms);
}

std::uint32_t Differentiation::first_screw_of(const MovingJoint& joint) {
  const auto known = std::ranges::find_if(moving_, [&joint](const Moving& moving) {
    return moving.robot == joint.robot && moving.joint == joint.joint;
  });
  if (known != moving_.end()) return known->first_screw;
  const auto first = static_cast<std::uint32_t>(screws_.size());
  moving_.push_back({joint.robot, joint.joint, first});
  screws_.resize(first + variables_of(scene_.robots[joint.robot].joints[joint.joint].type));
  return first;
}

void Differentiation::add_terms(const GradientRow& row, const ObjectPair& pair) {
  const auto first = static_cast<std::uint32_t>(terms_.size());
  const auto begin = rows_.variables.begin();
  for (const MovingJoint& moving : joints_between(scene_, pair)) {
    const RobotJoint& joint = scene_.robots[moving.robot].joints[moving.joint];
    const std::uint32_t screw = first_screw_of(moving);
    for (std::uint32_t i = 0; i < variables_of(joint.type); ++i) {
      const auto entry =
          std::lower_bound(begin + row.first, begin + row.end, joint.variable + i) - begin;
      terms_.push_back({screw + i, static_cast<std::uint32_t>(entry), moving.moves_b});
    }
  }
  terms_of_.push_back({first, static_cast<std::uint32_t>(terms_.size())});
}

void Differentiation::find_screws(const RobotInputs& inputs) noexcept {
  for (const Moving& moving : moving_) {
    const RobotJoint& joint = scene_.robots[moving.robot].joints[moving.joint];
    const std::span<const LinkState> links = inputs.links(moving.robot);
    screws_of(joint, links[joint.parent], links[moving.joint + 1], inputs.variables(),
              std::span(screws_).subspan(moving.first_screw, variables_of(joint.type)));
  }
}

void Differentiation::differentiate(std::span<const PairReport> pairs, const TickView& view,
                                    const RobotInputs& inputs, Gradients& gradients) noexcept {
  if (rows_.rows.empty()) return;
  find_screws(inputs);
  for (std::size_t r = 0; r < rows_.rows.size(); ++r) {
    const GradientRow& row = rows_.rows[r];
    const PairReport& pair = pairs[row.published];
    const std::span<double> rates =
        std::span(gradients.rates).subspan(row.first, row.end - row.first);
    if (!has_normal(pair)) {
      std::ranges::fill(rates, std::numeric_limits<double>::quiet_NaN());
      gradients.drifts[r] = std::numeric_limits<double>::quiet_NaN();
      gradients.alternatives[r] = unknown_alternative();
      continue;
    }
    std::ranges::fill(rates, 0.0);
    turns_.clear();
    for (std::uint32_t t = terms_of_[r].first; t < terms_of_[r].end; ++t) {
      const Term& term = terms_[t];
      const JointScrew& screw = screws_[term.screw];
      const Vec3 arm = (term.moves_b ? pair.witness_b : pair.witness_a) - screw.origin;
      const double along = dot(pair.normal, screw.linear + cross(screw.angular, arm));
      gradients.rates[term.entry] += term.moves_b ? along : -along;
      turns_.push_back(screw.angular);
    }
    gradients.alternatives[r] = alternative_of(pair, turns_, view);
    double by_joints = 0.0;
    for (std::uint32_t e = row.first; e < row.end; ++e) {
      by_joints += gradients.rates[e] * inputs.variables()[rows_.variables[e]].velocity;
    }
    gradients.drifts[r] = -pair.closing_speed - by_joints;
  }
}

}  // namespace clearance
