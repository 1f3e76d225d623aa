#include "tools/replay/run_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace clearance {
namespace {

constexpr std::size_t kMostStretches = 2400;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// fmin and fmax pass over a NaN.
void merge(StretchOfPair& into, const StretchOfPair& other) {
  into.distance = std::fmin(into.distance, other.distance);
  into.lower = std::fmin(into.lower, other.lower);
  into.closing_speed = std::fmax(into.closing_speed, other.closing_speed);
}

}  // namespace

RunSeries::RunSeries(const Scene& scene) : scene_(scene), visit_of_(scene.zones.size(), -1) {
  for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
    if (scene.pairs[pair].publish) pairs_.push_back(pair);
  }
  curves_.resize(pairs_.size());
  nearest_.resize(pairs_.size());
}

void RunSeries::add(const ReplayedTick& tick) {
  const Report& report = tick.report;
  if (ticks_++ == 0) first_ns_ = report.now_ns;
  last_s_ = 1e-9 * static_cast<double>(report.now_ns - first_ns_);
  if (in_stretch_ == 0) begin_stretch();
  for (std::size_t place = 0; place < report.pairs.size(); ++place) {
    add_pair(place, report.pairs[place]);
  }
  add_zones(report);
  in_stretch_ = (in_stretch_ + 1) % stride_;
}

void RunSeries::begin_stretch() {
  if (times_s_.size() == kMostStretches) halve();
  times_s_.push_back(last_s_);
  for (auto& curve : curves_) curve.push_back({kNaN, kNaN, kNaN});
}

// Two stretches become one.
void RunSeries::halve() {
  for (std::size_t i = 0; i < kMostStretches / 2; ++i) times_s_[i] = times_s_[2 * i];
  times_s_.resize(kMostStretches / 2);
  for (auto& curve : curves_) {
    for (std::size_t i = 0; i < kMostStretches / 2; ++i) {
      curve[i] = curve[2 * i];
      merge(curve[i], curve[2 * i + 1]);
    }
    curve.resize(kMostStretches / 2);
  }
  stride_ *= 2;
}

void RunSeries::add_pair(std::size_t place, const PairReport& pair) {
  if (pair.status >= PairStatus::kStale) return;
  merge(curves_[place].back(), {static_cast<float>(pair.distance), static_cast<float>(pair.lower),
                                static_cast<float>(pair.closing_speed)});
  NearestTick& nearest = nearest_[place];
  if (std::isnan(pair.distance) || (nearest.known && nearest.distance <= pair.distance)) return;
  nearest = {true, last_s_, pair.distance, pair.lower, pair.upper};
}

void RunSeries::add_zones(const Report& report) {
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    const ZoneReport& state = report.zones[zone];
    if (!state.active) {
      visit_of_[zone] = -1;
      continue;
    }
    if (visit_of_[zone] < 0) {
      visit_of_[zone] = static_cast<std::int64_t>(visits_.size());
      visits_.push_back({zone, state.pair, last_s_, last_s_, state.swept_clearance});
    }
    ZoneVisit& visit = visits_[static_cast<std::size_t>(visit_of_[zone])];
    visit.end_s = last_s_;
    if (state.swept_clearance < visit.clearance) {
      visit.clearance = state.swept_clearance;
      visit.pair = state.pair;
    }
  }
}

std::vector<ZoneVisit> RunSeries::visits() const { return visits_; }

std::vector<std::size_t> RunSeries::choose(
    const std::vector<std::pair<std::string, std::string>>& objects, std::size_t most) const {
  std::vector<std::size_t> places(pairs_.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  if (!objects.empty()) {
    std::erase_if(places, [&](std::size_t place) {
      const ObjectPair& pair = scene_.pairs[pairs_[place]];
      const std::string &a = scene_.objects[pair.first].name, &b = scene_.objects[pair.second].name;
      return std::ranges::none_of(objects, [&](const auto& asked) {
        return asked == std::pair(a, b) || asked == std::pair(b, a);
      });
    });
    return places;
  }
  std::erase_if(places, [&](std::size_t place) { return !nearest_[place].known; });
  std::ranges::stable_sort(places, {}, [&](std::size_t place) { return nearest_[place].distance; });
  if (places.size() > most) places.resize(most);
  return places;
}

}  // namespace clearance
