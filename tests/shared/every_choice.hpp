// All small inputs of a kind, one after the other: whatever a run chooses, some other run chooses
// everything else.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace clearance::test {

//   EveryChoice choice;
//   while (choice.next())
//     for (int step = 0; step < 5; ++step) send(kMessages[choice.of(std::size(kMessages))]);
class EveryChoice {
 public:
  // Begins another run. False once there was a run for each sequence of choices.
  bool next() {
    if (std::exchange(has_begun_, true)) {
      while (!made_.empty() && made_.back().value + 1 == made_.back().count) made_.pop_back();
      if (made_.empty()) return false;
      ++made_.back().value;
    }
    at_ = 0;
    ++runs_;
    return true;
  }
  // A number below `count`, which is above 0. It may depend on what this run has chosen before.
  std::size_t of(std::size_t count) {
    if (at_ == made_.size()) made_.push_back({0, count});
    return made_[at_++].value;
  }
  bool flag() { return of(2) == 1; }
  [[nodiscard]] std::size_t runs() const noexcept { return runs_; }

 private:
  struct Choice {
    std::size_t value, count;
  };
  std::vector<Choice> made_;
  std::size_t at_ = 0, runs_ = 0;
  bool has_begun_ = false;
};

}  // namespace clearance::test
