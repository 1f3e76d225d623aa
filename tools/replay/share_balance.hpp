// A cell in shares of the same cost, by what a replay has evaluated.
//
// A share costs what its pairs cost: each is kept in every tick, and evaluated in some of them. The
// cell says what an evaluation costs, and the replay counts how often it takes place. Both are the
// same on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// Returns the message that `pairs` pairs are too few for this number of shares.
[[nodiscard]] std::string an_empty_share(std::size_t shares, std::size_t pairs);

class ShareBalance {
 public:
  explicit ShareBalance(std::uint32_t count) : count_(count) {}

  void add(const ReplayedTick& tick);

  // The key `shares` of the cell, with a comment line for each share; "": there is no such
  // division, and error() says why. If the cell changes during the run, the key is that of the last
  // cell.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string error() const;

 private:
  void begin(const ReplayedTick& tick);
  [[nodiscard]] std::vector<std::uint64_t> measured_costs() const;  // of all ticks, by pair

  std::uint32_t count_;
  // These are of the scene of the last tick.
  const Scene* scene_ = nullptr;
  bool is_one_share_ = false;
  std::vector<std::string> names_;  // of its objects
  std::vector<ObjectPair> pairs_;
  std::vector<std::uint64_t> evaluated_, expected_;  // costs: of an evaluation, of a tick
  std::vector<std::uint64_t> evaluations_;
  std::uint64_t ticks_ = 0;
};

}  // namespace clearance
