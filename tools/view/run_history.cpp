#include "tools/view/run_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "monitor/interface/report.hpp"
#include "tools/view/json_number.hpp"

namespace clearance::view {
namespace {

using Piece = RunHistory::Piece;
using Extremes = RunHistory::Extremes;

// Extremes that are kept, 64 MB. An hour of 162 pairs is kept in stretches of 128 ms.
constexpr std::size_t kMostExtremes = 1 << 23;
constexpr std::int64_t kShortestNs = 4'000'000;

bool is_known(const clearance_msg_PairDistance& pair) {
  return pair.status < static_cast<std::uint8_t>(PairStatus::kStale);
}

Piece piece_of(const clearance_msg_Distances& report, std::int64_t log_ns) {
  Piece piece{.begin_ns = log_ns, .time_ns = log_ns};
  if (report.minimum_known && is_known(report.minimum)) {
    piece.distance = report.minimum.distance;
    piece.lower = report.minimum.lower;
  }
  if (report.publish_ns != 0) {
    piece.tick_us =
        1e-3 * static_cast<double>(report.publish_ns - report.clock_offset_ns - report.now_ns);
  }
  return piece;
}

// The stretches that fit into memory with so many columns.
std::size_t most_stretches(std::size_t columns) {
  return std::max<std::size_t>(kMostExtremes / std::max<std::size_t>(columns, 8), 2);
}

}  // namespace

void merge(const RunHistory::Piece& later, RunHistory::Piece& piece) {
  piece.tick_us = std::fmax(piece.tick_us, later.tick_us);
  piece.scaling = std::fmin(piece.scaling, later.scaling);
  if (!(std::isnan(piece.distance) || later.distance < piece.distance)) return;
  piece.time_ns = std::isnan(later.distance) ? piece.time_ns : later.time_ns;
  piece.distance = later.distance;
  piece.lower = later.lower;
}

void merge(const RunHistory::Extremes& later, RunHistory::Extremes& extremes) {
  extremes.distance = std::fmin(extremes.distance, later.distance);
  extremes.closing_speed = std::fmax(extremes.closing_speed, later.closing_speed);
}

RunHistory::RunHistory() : run_(0, most_stretches(0), kShortestNs) {}

RunHistory::Names RunHistory::names_of(const Scene& scene, const ObjectPair& pair) {
  return std::minmax(scene.objects[pair.first].name, scene.objects[pair.second].name);
}

void RunHistory::change_scene(const Scene& scene) {
  const std::size_t before = columns_.size();
  column_of_.assign(scene.pairs.size(), kNotPublished);
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    if (!scene.pairs[i].publish) continue;
    const auto next = static_cast<std::uint32_t>(columns_.size());
    column_of_[i] = columns_.try_emplace(names_of(scene, scene.pairs[i]), next).first->second;
  }
  if (columns_.size() > before) run_.widen(columns_.size(), most_stretches(columns_.size()));
}

void RunHistory::take(const clearance_msg_Distances& report, std::int64_t log_ns) {
  const std::span<Extremes> extremes = run_.add(piece_of(report, log_ns));
  for (const auto& pair : std::span(report.pairs._buffer, report.pairs._length)) {
    const std::uint32_t column =
        pair.pair < column_of_.size() ? column_of_[pair.pair] : kNotPublished;
    if (column == kNotPublished || !is_known(pair)) continue;
    merge({static_cast<float>(pair.distance), static_cast<float>(pair.closing_speed)},
          extremes[column]);
  }
}

void RunHistory::take(const clearance_msg_Separation& separation, std::int64_t log_ns) {
  Piece piece{.begin_ns = log_ns, .time_ns = log_ns};
  for (const auto& zone : std::span(separation.zones._buffer, separation.zones._length)) {
    piece.scaling = std::fmin(piece.scaling, zone.scaling);
  }
  for (const auto& stop : std::span(separation.stops._buffer, separation.stops._length)) {
    piece.scaling = std::fmin(piece.scaling, stop.scaling);
  }
  run_.add(piece);
}

void RunHistory::take(const clearance_msg_Health& health, std::int64_t log_ns) {
  for (const auto& each : std::span(health.witnesses._buffer, health.witnesses._length)) {
    if (*each.link == '\0' || std::isnan(each.residual_p50)) continue;
    medians_[fmt::format("{}: {}", each.sensor, each.link)].emplace_back(log_ns, each.residual_p50);
  }
}

Piece RunHistory::least() const {
  Piece least;
  for (const Piece& piece : run_.heads()) merge(piece, least);
  return least;
}

std::vector<Piece> RunHistory::pieces(std::size_t most) const {
  std::vector<Piece> merged;
  if (run_.heads().empty()) return merged;
  const std::int64_t begin_ns = run_.heads().front().begin_ns;
  const double span = static_cast<double>(run_.heads().back().begin_ns - begin_ns) + 1.0;
  const auto number = [&](const Piece& piece) {
    return std::floor(static_cast<double>(piece.begin_ns - begin_ns) / span *
                      static_cast<double>(most));
  };
  for (const Piece& piece : run_.heads()) {
    if (!merged.empty() && number(piece) == number(merged.back())) {
      merge(piece, merged.back());
    } else {
      merged.push_back(piece);
    }
  }
  return merged;
}

RunHistory::Extremes RunHistory::extremes_of(std::uint32_t column, std::size_t first,
                                             std::size_t last) const {
  Extremes extremes;
  if (column == kNotPublished) return extremes;
  for (std::size_t i = first; i < last; ++i) merge(run_.cells(i)[column], extremes);
  return extremes;
}

nlohmann::json RunHistory::residuals(std::int64_t from_ns, std::int64_t to_ns) const {
  std::vector<std::pair<double, const std::string*>> largest;
  const auto is_within = [&](std::int64_t ns) { return ns > from_ns && ns <= to_ns; };
  for (const auto& [name, curve] : medians_) {
    double most = -1.0;
    for (const auto& [ns, median] : curve)
      if (is_within(ns)) most = std::max(most, std::abs(median));
    if (most >= 0.0) largest.emplace_back(-most, &name);
  }
  std::ranges::stable_sort(largest, {}, [](const auto& each) { return each.first; });
  nlohmann::json all = nlohmann::json::object();
  for (std::size_t i = 0; i < std::min(largest.size(), kMostResiduals); ++i) {
    for (const auto& [ns, median] : medians_.at(*largest[i].second)) {
      if (!is_within(ns)) continue;
      const double s = 1e-9 * static_cast<double>(ns - run_.heads().front().begin_ns);
      all[*largest[i].second].push_back({s, median});
    }
  }
  return all;
}

std::string RunHistory::window(std::int64_t end_ns, std::int64_t width_ns, const Scene& scene,
                               std::span<const std::uint32_t> pairs) const {
  std::vector<std::pair<std::string, std::uint32_t>> columns;  // by the pair's id, as text
  for (const std::uint32_t pair : pairs) {
    if (pair >= scene.pairs.size()) continue;
    const auto known = columns_.find(names_of(scene, scene.pairs[pair]));
    columns.emplace_back(std::to_string(pair),
                         known == columns_.end() ? kNotPublished : known->second);
  }
  nlohmann::json all = {
      {"s", nlohmann::json::array()},       {"distance", nlohmann::json::array()},
      {"lower", nlohmann::json::array()},   {"tick", nlohmann::json::array()},
      {"scaling", nlohmann::json::array()}, {"pairs", nlohmann::json::object()},
      {"speeds", nlohmann::json::object()}, {"residuals", residuals(end_ns - width_ns, end_ns)}};
  const auto first =
      std::ranges::upper_bound(run_.heads(), end_ns - width_ns, {}, &Piece::begin_ns);
  const auto last = std::ranges::upper_bound(run_.heads(), end_ns, {}, &Piece::begin_ns);
  const auto from = static_cast<std::size_t>(first - run_.heads().begin()),
             to = static_cast<std::size_t>(last - run_.heads().begin());
  const std::size_t together = (to - from) / kMostPoints + 1;
  for (std::size_t i = from; i < to; i += together) {
    const std::size_t end = std::min(to, i + together);
    Piece piece = run_.heads()[i];
    for (std::size_t j = i + 1; j < end; ++j) merge(run_.heads()[j], piece);
    all["s"].push_back(1e-9 * static_cast<double>(piece.time_ns - run_.heads().front().begin_ns));
    all["distance"].push_back(number(piece.distance));
    all["lower"].push_back(number(piece.lower));
    all["tick"].push_back(number(piece.tick_us));
    all["scaling"].push_back(number(piece.scaling));
    for (const auto& [pair, column] : columns) {
      const Extremes extremes = extremes_of(column, i, end);
      all["pairs"][pair].push_back(number(extremes.distance));
      all["speeds"][pair].push_back(number(extremes.closing_speed));
    }
  }
  return all.dump();
}

}  // namespace clearance::view
