#include "monitor/wire/changed_pairs.hpp"

#include <bit>
#include <cstdint>

namespace clearance {
namespace {

bool same(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same(const clearance_msg_Vector3& a, const clearance_msg_Vector3& b) noexcept {
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

bool has_changed(const clearance_msg_PairDistance& listed,
                 const clearance_msg_PairDistance& now) noexcept {
  const bool is_alike =
      listed.pair == now.pair && listed.part_a == now.part_a && listed.part_b == now.part_b &&
      listed.status == now.status && same(listed.distance, now.distance) &&
      same(listed.lower, now.lower) && same(listed.upper, now.upper) &&
      same(listed.swept_lower, now.swept_lower) && same(listed.witness_a, now.witness_a) &&
      same(listed.witness_b, now.witness_b) && same(listed.normal, now.normal) &&
      same(listed.closing_speed, now.closing_speed) &&
      same(listed.time_to_contact, now.time_to_contact);
  const auto is_older = [](std::int64_t before, std::int64_t age) {
    return (before < 0) != (age < 0) || age > before + kUnlistedAge;
  };
  return !is_alike || is_older(listed.age_a_ns, now.age_a_ns) ||
         is_older(listed.age_b_ns, now.age_b_ns);
}

}  // namespace

void ChangedPairs::reduce(clearance_msg_Distances& message) {
  message.changes_since = 0;
  if (full_every_ == 0) return;
  auto* const pairs = message.pairs._buffer;
  const bool follows = cycle_ != 0 && message.cycle == cycle_ + 1 && message.lineage == lineage_ &&
                       listed_.size() == message.pairs._length;
  cycle_ = message.cycle;
  lineage_ = message.lineage;
  if (!follows || message.cycle % full_every_ == 0) {
    listed_.assign(pairs, pairs + message.pairs._length);
    message.changes_since = message.cycle;
    return;
  }
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < listed_.size(); ++i) {
    if (!has_changed(listed_[i], pairs[i])) continue;
    listed_[i] = pairs[i];
    pairs[kept++] = pairs[i];
  }
  message.pairs._length = kept;
  message.changes_since = message.cycle - 1;
}

}  // namespace clearance
