#include "monitor/intake/last_depths.hpp"

#include <algorithm>
#include <utility>

namespace clearance {
namespace {

bool is_frozen(const std::vector<std::uint32_t>& now, const std::vector<std::uint32_t>& then) {
  if (now.size() != then.size()) return false;
  std::size_t there = 0, same = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    there += now[i] != 0 || then[i] != 0 ? 1 : 0;
    same += now[i] != 0 && now[i] == then[i] ? 1 : 0;
  }
  return static_cast<double>(same) >= LastDepths::kFrozenShare * static_cast<double>(there);
}

}  // namespace

bool LastDepths::has(const MessageCloud& cloud) {
  const std::size_t count = std::size_t{cloud.columns} * cloud.rows;
  const std::size_t stride = (count + kElements - 1) / kElements;
  newest_.clear();
  for (std::size_t i = 0; i < count; i += stride) newest_.push_back(cloud.depth_digest(i));
  const std::size_t kept = std::min<std::uint64_t>(added_, kKept);
  return std::any_of(pictures_.begin(), pictures_.begin() + static_cast<std::ptrdiff_t>(kept),
                     [&](const auto& each) { return is_frozen(newest_, each); });
}

void LastDepths::add() { std::swap(pictures_[added_++ % kKept], newest_); }

}  // namespace clearance
