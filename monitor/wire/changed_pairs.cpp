#include "monitor/wire/changed_pairs.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/wire/message_fields.hpp"

namespace clearance {
namespace {

// Compares a pair as it was listed last with itself now. Its ages are the only signed integers of
// its fields, and its cycles the only ones of 64 bits without a sign.
struct Comparison {
  bool& has_changed;

  template <class Value>
  void operator()(const Field&, const Value& listed, const Value& now) const noexcept {
    if constexpr (std::is_same_v<Value, std::int64_t>) {
      has_changed |= (listed < 0) != (now < 0) || elapsed(listed, now) > kUnlistedAge;
    } else if constexpr (!std::is_same_v<Value, std::uint64_t>) {
      has_changed |= std::memcmp(&listed, &now, sizeof now) != 0;
    }
  }
};

bool has_changed(const clearance_msg_PairDistance& listed,
                 const clearance_msg_PairDistance& now) noexcept {
  bool changed = false;
  for_each_field(Comparison{changed}, listed, now);
  return changed;
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
