#include "tools/replay/share_balance.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <numeric>

#include "config/cell/shares.hpp"
#include "config/text/sentences.hpp"
#include "config/yaml/yaml_emitter.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {
namespace {

std::uint64_t sum_of(const std::vector<std::uint64_t>& values, const Share& share) {
  std::uint64_t sum = 0;
  for (const std::uint32_t pair : share.pairs) sum += values[pair];
  return sum;
}

double percent(std::uint64_t part, const std::vector<std::uint64_t>& of) {
  const std::uint64_t all = std::accumulate(of.begin(), of.end(), std::uint64_t{0});
  return 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

std::string an_empty_share(std::size_t shares, std::size_t pairs) {
  return fmt::format("{} shares of {}: one would be empty; expected fewer", shares,
                     counted(pairs, "pair"));
}

void ShareBalance::begin(const ReplayedTick& tick) {
  const Scene& scene = tick.cell.scene;
  scene_ = &scene;
  is_one_share_ = tick.cell.shares.is_one();
  names_.clear();
  for (const Object& object : scene.objects) names_.push_back(object.name);
  pairs_ = scene.pairs;
  expected_ = expected_costs(scene.objects, scene.pairs);
  evaluated_.clear();
  for (const ObjectPair& pair : pairs_) evaluated_.push_back(evaluation_cost(scene.objects, pair));
  evaluations_.assign(pairs_.size(), 0);
  ticks_ = 0;
}

void ShareBalance::add(const ReplayedTick& tick) {
  if (scene_ != &tick.cell.scene) begin(tick);
  ++ticks_;
  for (std::uint32_t pair = 0; pair < pairs_.size(); ++pair)
    evaluations_[pair] += is_evaluated(tick.monitor.pair(pair).status) ? 1 : 0;
}

std::vector<std::uint64_t> ShareBalance::measured_costs() const {
  std::vector<std::uint64_t> costs(pairs_.size());
  for (std::size_t pair = 0; pair < costs.size(); ++pair)
    costs[pair] = ticks_ * kKeptCost + evaluations_[pair] * evaluated_[pair];
  return costs;
}

std::string ShareBalance::error() const {
  if (ticks_ == 0) return "no tick was replayed, so no cost was measured";
  if (is_one_share_)
    return "the recording is of one share of its cell; expected one of the whole cell, or --cell";
  const auto shares = shares_of_runs(pairs_.size(), balanced_begins(measured_costs(), count_));
  if (std::ranges::all_of(shares, [](const Share& share) { return !share.pairs.empty(); }))
    return {};
  return an_empty_share(count_, pairs_.size());
}

std::string ShareBalance::text() const {
  if (!error().empty()) return {};
  const std::vector<std::uint64_t> costs = measured_costs();
  const std::vector<std::uint32_t> begins = balanced_begins(costs, count_);
  const auto shares = shares_of_runs(pairs_.size(), begins);
  const auto unmeasured = shares_of_runs(pairs_.size(), balanced_begins(expected_, count_));
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "shares" << YAML::Value << YAML::Flow << YAML::BeginMap
      << YAML::Key << "auto" << YAML::Value << count_ << YAML::Key << "begin" << YAML::Value
      << YAML::BeginSeq;
  for (const std::uint32_t pair : begins) {
    out << YAML::BeginSeq;
    emit_text(out, names_[pairs_[pair].first]);
    emit_text(out, names_[pairs_[pair].second]);
    out << YAML::EndSeq;
  }
  out << YAML::EndSeq << YAML::EndMap << YAML::EndMap;
  std::string text = fmt::format("{}\n", out.c_str());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto a_tick =
        static_cast<double>(sum_of(evaluations_, shares[i])) / static_cast<double>(ticks_);
    text += fmt::format(
        "# share {}: {} pairs, {:.1f} evaluations a tick, {:.1f} % of the cost "
        "({:.1f} % without 'begin')\n",
        shares[i].name, shares[i].pairs.size(), a_tick, percent(sum_of(costs, shares[i]), costs),
        percent(sum_of(costs, unmeasured[i]), costs));
  }
  return text;
}

}  // namespace clearance
