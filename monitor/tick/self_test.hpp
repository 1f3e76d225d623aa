// Looks for bits that have flipped in what a monitor holds as constant, some of it in each tick,
// and asks a query whose answer is known. SELF_TEST.md says what this finds, and what it does
// not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "monitor/tick/constant_memory.hpp"
#include "monitor/tick/known_queries.hpp"

namespace clearance {

class SelfTest {
 public:
  // What a tick may read, in bytes of cache lines.
  static constexpr std::size_t kBytesATick = 4096;

  // Notes the checksums of all blocks, which must outlive this, and asks all known queries.
  // `before`: the self-test of a monitor from which some of the memory came. If that one does not
  // hold any more, this one has failed.
  SelfTest(ConstantMemory memory, const SelfTest* before);

  // The part of a tick. Allocates, throws and locks nothing; the same in each run.
  void tick() noexcept;
  // True from the first difference on.
  [[nodiscard]] bool failed() const noexcept { return failed_.has_value(); }
  // A sentence for people, once it has failed: which table or query. Allocates.
  [[nodiscard]] std::string fault() const;

  // Whatever flips is found within so many ticks, if it stays flipped.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] std::size_t bytes() const noexcept;
  [[nodiscard]] const ConstantMemory& memory() const noexcept { return memory_; }
  // Reads everything at once. Any thread, also while tick() runs in another one.
  [[nodiscard]] bool holds() const noexcept;

 private:
  // A block or a known query; neither: the test of the monitor before.
  struct Fault {
    std::optional<std::size_t> block = {}, query = {};
  };
  [[nodiscard]] bool holds(std::size_t block) const noexcept;

  ConstantMemory memory_;
  std::vector<std::uint64_t> sums_;  // by block
  std::uint64_t ticks_ = 1;
  std::size_t next_block_ = 0, next_query_ = 0;
  std::optional<Fault> failed_;
};

}  // namespace clearance
