// What a report says, as bytes: equal when it is the same to the bit.
#pragma once

#include <cstring>
#include <vector>

#include "monitor/report.hpp"

namespace clearance::test {

template <class T>
inline void append(std::vector<unsigned char>& bytes, const T& figure) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(T));
  std::memcpy(bytes.data() + size, &figure, sizeof(T));
}

inline void append(std::vector<unsigned char>& bytes, const PairReport& pair) {
  append(bytes, pair.status);
  append(bytes, pair.evaluated_cycle);
  append(bytes, pair.refresh_age_cycles);
  append(bytes, pair.part_a);
  append(bytes, pair.part_b);
  for (const double figure : {pair.distance, pair.lower, pair.upper, pair.swept_lower,
                              pair.closing_speed, pair.time_to_contact}) {
    append(bytes, figure);
  }
  for (const Vec3& v : {pair.witness_a, pair.witness_b, pair.normal}) {
    for (int i = 0; i < 3; ++i) append(bytes, v[i]);
  }
}

[[nodiscard]] inline std::vector<unsigned char> bytes_of(const Report& report) {
  std::vector<unsigned char> bytes;
  append(bytes, report.queries);
  append(bytes, report.evaluated);
  append(bytes, report.oldest_evaluation_cycles);
  append(bytes, report.minimum_certified);
  append(bytes, report.lower_all);
  append(bytes, report.swept_lower_all);
  append(bytes, report.minimum);
  for (const PairReport& pair : report.pairs) append(bytes, pair);
  for (const ZoneReport& zone : report.zones) {
    append(bytes, zone.active);
    append(bytes, zone.certified);
    append(bytes, zone.clearance);
    append(bytes, zone.swept_clearance);
    append(bytes, zone.pair);
  }
  for (const ZoneSeparation& zone : report.separated_zones) {
    append(bytes, zone.validity);
    append(bytes, zone.pair);
    for (const double figure : {zone.remaining, zone.speed_limit, zone.scaling})
      append(bytes, figure);
  }
  for (const PairSeparation& pair : report.separated_pairs) {
    append(bytes, pair.validity);
    for (const double figure : {pair.clearance, pair.human_speed, pair.robot_speed, pair.human_term,
                                pair.robot_term, pair.stopping_term, pair.protective_distance,
                                pair.remaining, pair.speed_limit, pair.scaling}) {
      append(bytes, figure);
    }
  }
  append(bytes, report.rejected);
  return bytes;
}

}  // namespace clearance::test
