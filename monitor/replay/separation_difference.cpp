#include "monitor/replay/separation_difference.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "monitor/pair_name.hpp"

namespace clearance {
namespace {

// Any NaN is any other: what is not known has no bits worth comparing.
bool agrees(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}
bool agrees(std::int64_t a, std::int64_t b) { return a == b; }
bool agrees(std::uint32_t a, std::uint32_t b) { return a == b; }
bool agrees(std::uint8_t a, std::uint8_t b) { return a == b; }

// 17 digits identify a double.
std::string written(double value) { return fmt::format("{:.17g}", value); }
template <class T>
std::string written(T value) {
  return fmt::format("{}", value);
}

template <class T, class Field, std::size_t N>
std::optional<std::string> first_of(const std::array<std::pair<const char*, Field T::*>, N>& fields,
                                    const T& recorded, const T& replayed) {
  for (const auto& [name, field] : fields) {
    if (agrees(recorded.*field, replayed.*field)) continue;
    return fmt::format("{}: recorded {}, replayed {}", name, written(recorded.*field),
                       written(replayed.*field));
  }
  return std::nullopt;
}

using Pair = clearance_msg_PairSeparation;
using ZoneOf = clearance_msg_ZoneSeparation;

constexpr std::array<std::pair<const char*, std::uint32_t Pair::*>, 2> kPairIds = {
    {{"zone", &Pair::zone}, {"pair", &Pair::pair}}};
constexpr std::array<std::pair<const char*, double Pair::*>, 10> kPairFigures = {
    {{"clearance", &Pair::clearance},
     {"human_speed", &Pair::human_speed},
     {"robot_speed", &Pair::robot_speed},
     {"human_term", &Pair::human_term},
     {"robot_term", &Pair::robot_term},
     {"stopping_term", &Pair::stopping_term},
     {"protective_distance", &Pair::protective_distance},
     {"remaining", &Pair::remaining},
     {"speed_limit", &Pair::speed_limit},
     {"scaling", &Pair::scaling}}};
constexpr std::array<std::pair<const char*, std::int64_t Pair::*>, 2> kPairAges = {
    {{"age_human_ns", &Pair::age_human_ns}, {"age_robot_ns", &Pair::age_robot_ns}}};
constexpr std::array<std::pair<const char*, std::uint8_t Pair::*>, 1> kPairStates = {
    {{"validity", &Pair::validity}}};

constexpr std::array<std::pair<const char*, std::uint32_t ZoneOf::*>, 2> kZoneIds = {
    {{"zone", &ZoneOf::zone}, {"pair", &ZoneOf::pair}}};
constexpr std::array<std::pair<const char*, double ZoneOf::*>, 3> kZoneFigures = {
    {{"remaining", &ZoneOf::remaining},
     {"speed_limit", &ZoneOf::speed_limit},
     {"scaling", &ZoneOf::scaling}}};
constexpr std::array<std::pair<const char*, std::uint8_t ZoneOf::*>, 1> kZoneStates = {
    {{"validity", &ZoneOf::validity}}};

std::optional<std::string> differing(const Pair& recorded, const Pair& replayed) {
  if (auto found = first_of(kPairIds, recorded, replayed)) return found;
  if (auto found = first_of(kPairStates, recorded, replayed)) return found;
  if (auto found = first_of(kPairFigures, recorded, replayed)) return found;
  return first_of(kPairAges, recorded, replayed);
}

std::optional<std::string> differing(const ZoneOf& recorded, const ZoneOf& replayed) {
  if (auto found = first_of(kZoneIds, recorded, replayed)) return found;
  if (auto found = first_of(kZoneStates, recorded, replayed)) return found;
  return first_of(kZoneFigures, recorded, replayed);
}

std::string zone_name(const Scene& scene, std::uint32_t zone) {
  return zone < scene.zones.size() ? fmt::format("zone '{}'", scene.zones[zone].name)
                                   : fmt::format("zone {}", zone);
}

}  // namespace

// Pairs come first: their zone follows from them.
std::optional<std::string> separation_difference(const Scene& scene,
                                                 const clearance_msg_Separation& recorded,
                                                 const clearance_msg_Separation& replayed) {
  const bool has_pairs = recorded.pairs._length > 0;
  if (recorded.zones._length != replayed.zones._length ||
      (has_pairs && recorded.pairs._length != replayed.pairs._length)) {
    return fmt::format("separation: recorded {} zones and {} pairs, replayed {} and {}",
                       recorded.zones._length, recorded.pairs._length, replayed.zones._length,
                       replayed.pairs._length);
  }
  for (std::uint32_t i = 0; i < recorded.pairs._length; ++i) {
    const Pair &there = recorded.pairs._buffer[i], &here = replayed.pairs._buffer[i];
    if (const auto found = differing(there, here)) {
      return fmt::format("separation of {}, {}, {}", zone_name(scene, here.zone),
                         pair_name(scene, here.pair), *found);
    }
  }
  for (std::uint32_t i = 0; i < recorded.zones._length; ++i) {
    const ZoneOf &there = recorded.zones._buffer[i], &here = replayed.zones._buffer[i];
    if (const auto found = differing(there, here))
      return fmt::format("separation of {}, {}", zone_name(scene, here.zone), *found);
  }
  return std::nullopt;
}

}  // namespace clearance
