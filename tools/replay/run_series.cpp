#include "tools/replay/run_series.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "monitor/pair_name.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMostStretches = 2400;
constexpr std::int64_t kShortestNs = 1'000'000;

std::vector<std::uint32_t> published(const Scene& scene) {
  std::vector<std::uint32_t> pairs;
  for (std::uint32_t pair = 0; pair < scene.pairs.size(); ++pair) {
    if (scene.pairs[pair].publish) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

// fmin and fmax ignore a NaN.
void merge(const StretchOfPair& later, StretchOfPair& into) {
  into.distance = std::fmin(into.distance, later.distance);
  into.lower = std::fmin(into.lower, later.lower);
  into.closing_speed = std::fmax(into.closing_speed, later.closing_speed);
}

void merge(const StretchOfRun& /*later*/, StretchOfRun& /*into*/) {}

RunSeries::RunSeries(const Scene& scene)
    : scene_(scene),
      pairs_(published(scene)),
      curves_(pairs_.size(), kMostStretches, kShortestNs),
      nearest_(pairs_.size()) {
  follow(scene);
}

// Visits of zones end with the cell.
void RunSeries::follow(const Scene& scene) {
  in_force_ = &scene;
  visit_of_.assign(scene.zones.size(), -1);
  const auto names = [](const Scene& of, std::uint32_t pair) {
    const ObjectPair& objects = of.pairs[pair];
    return std::minmax(of.objects[objects.first].name, of.objects[objects.second].name);
  };
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  for (std::size_t place = 0; place < pairs_.size(); ++place)
    places.emplace(names(scene_, pairs_[place]), place);
  place_of_.clear();
  for (const std::uint32_t pair : published(scene)) {
    const auto found = places.find(names(scene, pair));
    place_of_.push_back(found == places.end() ? kNoPlace : found->second);
  }
}

void RunSeries::add(const ReplayedTick& tick) {
  const Report& report = tick.report;
  if (&tick.cell.scene != in_force_) follow(tick.cell.scene);
  if (ticks_++ == 0) first_ns_ = report.now_ns;
  last_s_ = 1e-9 * static_cast<double>(report.now_ns - first_ns_);
  const std::span<StretchOfPair> stretch = curves_.add({report.now_ns - first_ns_});
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const std::size_t place = place_of_[i];
    if (place != kNoPlace) add_pair(place, report.pairs[i], stretch[place]);
  }
  add_zones(report);
}

void RunSeries::add_pair(std::size_t place, const PairReport& pair, StretchOfPair& stretch) {
  if (pair.status >= PairStatus::kStale) return;
  merge({static_cast<float>(pair.distance), static_cast<float>(pair.lower),
         static_cast<float>(pair.closing_speed)},
        stretch);
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
      visits_.push_back({in_force_->zones[zone].name, pair_name(*in_force_, state.pair), last_s_,
                         last_s_, state.swept_clearance});
    }
    ZoneVisit& visit = visits_[static_cast<std::size_t>(visit_of_[zone])];
    visit.end_s = last_s_;
    if (state.swept_clearance < visit.clearance) {
      visit.clearance = state.swept_clearance;
      visit.pair = pair_name(*in_force_, state.pair);
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
