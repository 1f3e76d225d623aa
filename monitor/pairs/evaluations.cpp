#include "monitor/pairs/evaluations.hpp"

#include <algorithm>

#include "monitor/interface/invariant.hpp"

namespace clearance {

ClosestPoints::ClosestPoints() noexcept
    : distance(kNan),
      lower(-kInfinity),
      witness_a(Vec3::Constant(kNan)),
      witness_b(Vec3::Constant(kNan)),
      normal(Vec3::Constant(kNan)) {}

Evaluations::Evaluations(std::size_t part_pairs, std::size_t queries)
    : queries_(queries), slot_(part_pairs, kNever), cycle_(part_pairs, 0), records_(1) {}

void Evaluations::keep(std::uint32_t part_pair) {
  slot_[part_pair] = first_shared_++;
  records_.emplace_back();
}

// More than twice the queries of a tick, so that a record is free while others are of this tick.
void Evaluations::share() {
  const std::size_t others = slot_.size() + 1 - first_shared_;
  const std::size_t most = std::max({kShared, others / kPartPairsPerRecord, 2 * queries_ + 1});
  shared_ = std::min(others, most);
  records_.reserve(first_shared_ + shared_);
  user_.reserve(shared_);
  next_ = first_shared_;
}

// The record that was assigned longest ago goes to another part pair, unless it is of this tick.
Evaluation& Evaluations::assign(std::uint32_t part_pair, std::uint64_t cycle) noexcept {
  if (user_.size() < shared_) {
    user_.push_back(part_pair);
    slot_[part_pair] = static_cast<std::uint32_t>(records_.size());
    return records_.emplace_back();
  }
  const auto advance = [this] {
    const std::uint32_t record = next_;
    next_ = next_ + 1 < records_.size() ? next_ + 1 : first_shared_;
    return record;
  };
  std::uint32_t record = advance();
  for (std::size_t tried = 1; cycle_[user_[record - first_shared_]] == cycle; ++tried) {
    CLEARANCE_INVARIANT(tried < user_.size());
    record = advance();
  }
  std::uint32_t& user = user_[record - first_shared_];
  slot_[user] = kNever;
  cycle_[user] = 0;
  user = part_pair;
  slot_[part_pair] = record;
  return records_[record] = Evaluation();
}

}  // namespace clearance
