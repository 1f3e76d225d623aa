// The scenes that followed the first one of a recording, and when.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/recording/recorded_cell.hpp"

namespace clearance {

class SceneHistory {
 public:
  // A history without a change.
  explicit SceneHistory(const Cell& first);
  // Reads the descriptions of the recording's scenes. `first` is the cell that the replay begins
  // with, and outlives this. `adapt` sets what the replay demands of every scene, as it was done
  // for the first one. If the first one is another cell than the recorded ones, no change follows.
  SceneHistory(const Cell& first, const std::vector<std::filesystem::path>& files,
               std::function<void(Scene&)> adapt, bool is_recorded = true);

  [[nodiscard]] const Cell& first() const noexcept { return first_; }
  // Whether the recording describes other scenes than the first one.
  [[nodiscard]] bool has_changes() const noexcept;

  // The number of changes of the recorded cell that do not follow, as the first cell is another.
  [[nodiscard]] std::size_t changes_left_out() const noexcept;

  // Whether the first cell had followed another one before the recording begins. Batches for one
  // that former() lacks cannot be told from others.
  [[nodiscard]] bool begins_changed() const noexcept {
    return !described_.empty() && described_.front().since.from > 0;
  }

  // Scenes before the recording begins, whose ids batches may have.
  [[nodiscard]] const std::vector<FormerScene>& former() const noexcept { return former_; }

  // The next change of this run of the daemon whose first cycle is after `cycle`; null: none.
  // `joined`: the number of the last state of a partner in front of it, since each state changes
  // how cycles are counted.
  [[nodiscard]] const DescribedScene* next_change(std::uint64_t daemon, std::uint64_t joined,
                                                  std::uint64_t cycle) const;

  // The cell of a revision, read when it is asked for first. Null: the recording does not describe
  // it, or it cannot be read, or is read as another one; then error() says why.
  [[nodiscard]] const Cell* cell(std::uint64_t revision);
  // If the first cell is another one than the recorded ones: the recorded cell, as cell() has it
  // otherwise.
  [[nodiscard]] const Cell* recorded(std::uint64_t revision);
  [[nodiscard]] const std::string& error() const noexcept { return error_; }

 private:
  [[nodiscard]] const Cell* read(const std::vector<DescribedScene>& scenes, std::uint64_t revision);

  const Cell& first_;
  std::vector<DescribedScene> described_, of_others_;
  std::vector<FormerScene> former_;
  std::function<void(Scene&)> adapt_;
  std::map<std::uint64_t, std::unique_ptr<const Cell>> read_;  // by revision
  std::string error_;
};

}  // namespace clearance
