#include "config/cell/timing_reader.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "config/text/spelling.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// This limit keeps every derived count within its type.
constexpr std::int64_t kMaxBudget = 1'000'000'000;
// The slowest rate that a loop is tested with, and the fastest whose period is a useful tick.
constexpr Range kRates{.least = 1.0, .most = 10'000.0};  // Hz
// The range is from one tick at 1 kHz to some days.
constexpr Range kRefreshes{.least = 1e-3, .most = 1e6};  // s

// {on: NAME}
const YamlNode* read_tick(const YamlNode& node, Diagnostics& diagnostics) {
  MapReader map(node, "the tick", diagnostics);
  const YamlNode* const on = map.required("on");
  map.refuse_unknown_keys();
  return on;
}

}  // namespace

TimingPlaces read_timing(MapReader& map, const Quantities& quantities, Scene& scene) {
  Diagnostics& diagnostics = quantities.diagnostics();
  TimingPlaces places;
  if (const YamlNode* rate = map.optional("rate_hz")) {
    scene.rate_hz =
        read_number(*rate, kRates, "the rate in Hz", diagnostics).value_or(scene.rate_hz);
  }
  if (const YamlNode* tick = map.optional("tick")) places.followed = read_tick(*tick, diagnostics);
  places.budget = map.optional("budget");
  if (places.budget != nullptr) {
    const auto queries =
        read_integer(*places.budget, 1, kMaxBudget, "distance queries a tick", diagnostics);
    if (queries) scene.budget = static_cast<std::uint32_t>(*queries);
  }
  if (const YamlNode* refresh = map.optional("refresh_s")) {
    scene.refresh_s = read_number(*refresh, kRefreshes,
                                  "seconds within which every pair is refreshed", diagnostics)
                          .value_or(scene.refresh_s);
  }
  if (const YamlNode* limit = map.optional("future_limit_ms")) {
    scene.future_limit_ns =
        quantities.milliseconds(*limit, "how far ahead of now a stamp may be", kNotNegative)
            .value_or(scene.future_limit_ns);
  }
  if (const YamlNode* limit = map.optional("response_limit_ms")) {
    scene.response_limit_ns = quantities.milliseconds(*limit, "the longest response", kPositive)
                                  .value_or(scene.response_limit_ns);
  }
  if (const YamlNode* gradients = map.optional("gradients"))
    scene.gradients = read_flag(*gradients, diagnostics).value_or(false);
  return places;
}

void find_followed(const TimingPlaces& places, Diagnostics& diagnostics, Scene& scene) {
  if (places.followed == nullptr) return;
  const std::string& name = places.followed->text;
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < scene.robots.size(); ++i) {
    if (scene.robots[i].is_attached) continue;
    names.push_back(scene.robots[i].name);
    if (names.back() == name) scene.tick_on = i;
  }
  for (std::uint32_t i = 0; i < scene.objects.size() && scene.is_free_running(); ++i) {
    const Object& object = scene.objects[i];
    if (object.fixed || object.is_seen() || object.pose_error > 0.0) continue;
    names.push_back(object.name);
    if (names.back() == name) scene.tick_on_object = i;
  }
  if (!scene.is_free_running()) return;
  diagnostics.add(*places.followed,
                  fmt::format("found {}; expected a robot or an object, whose joint states or "
                              "poses ticks follow{}",
                              describe(*places.followed), did_you_mean(name, names)));
}

}  // namespace clearance
