#include "monitor/tick/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "monitor/inputs/checksum.hpp"

namespace clearance {
namespace {

// Four sums side by side take a third of the time of one, whose steps wait for each other.
std::uint64_t sum_of(const ConstantBlock& block) noexcept {
  constexpr std::size_t kLanes = 4, kWord = sizeof(std::uint64_t);
  std::array<Checksum, kLanes> lanes;
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const std::byte* at = block.at + std::size_t{i} * block.stride;
    std::size_t left = block.size;
    for (; left >= kLanes * kWord; at += kLanes * kWord, left -= kLanes * kWord) {
      std::array<std::uint64_t, kLanes> words;
      std::memcpy(words.data(), at, sizeof words);
      for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane].add(words[lane]);
    }
    lanes[0].add_bytes({at, left});
  }
  Checksum sum;
  for (const Checksum& lane : lanes) sum.add(lane.value());
  return sum.value();
}

// The first block after a tick that begins with this one. A pass begins with the first block, so
// that each pass has the same ticks.
std::size_t after_tick(std::size_t block, std::span<const ConstantBlock> blocks) noexcept {
  std::size_t cost = 0;
  for (; block < blocks.size(); ++block) {
    cost += blocks[block].cost();
    if (cost > SelfTest::kBytesATick) break;
  }
  return block;
}

}  // namespace

SelfTest::SelfTest(ConstantMemory memory, const SelfTest* before) : memory_(std::move(memory)) {
  const auto blocks = memory_.blocks();
  for (const ConstantBlock& block : blocks) sums_.push_back(sum_of(block));
  const auto queries = known_queries();
  ticks_ = 0;
  for (std::size_t block = 0; block < blocks.size(); ++ticks_) block = after_tick(block, blocks);
  ticks_ = std::max<std::uint64_t>(ticks_, queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (queries[i].ask() != queries[i].answer) failed_ = Fault{.query = i};
  }
  if (before != nullptr && !before->holds()) failed_ = Fault{};
}

bool SelfTest::holds(std::size_t block) const noexcept {
  return sum_of(memory_.blocks()[block]) == sums_[block];
}

bool SelfTest::holds() const noexcept {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (!holds(i)) return false;
  }
  return true;
}

void SelfTest::tick() noexcept {
  if (failed_) return;
  const std::size_t end = after_tick(next_block_, memory_.blocks());
  for (std::size_t i = next_block_; i < end; ++i) {
    if (!holds(i)) failed_ = Fault{.block = i};
  }
  next_block_ = end < sums_.size() ? end : 0;
  const KnownQuery& query = known_queries()[next_query_];
  if (query.ask() != query.answer) failed_ = Fault{.query = next_query_};
  next_query_ = (next_query_ + 1) % known_queries().size();
}

std::string SelfTest::fault() const {
  if (!failed_) return "";
  if (failed_->query)
    return fmt::format("the known query of {} has another answer",
                       known_queries()[*failed_->query].what);
  if (!failed_->block) return "a table of the scene before has changed in memory";
  const ConstantBlock& block = memory_.blocks()[*failed_->block];
  return fmt::format("the table '{}' of {} has changed in memory", block.table,
                     memory_.owners()[block.owner]);
}

std::size_t SelfTest::bytes() const noexcept {
  std::size_t sum = 0;
  for (const ConstantBlock& block : memory_.blocks()) sum += std::size_t{block.size} * block.count;
  return sum;
}

}  // namespace clearance
