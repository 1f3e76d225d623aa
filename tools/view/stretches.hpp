// Summarises a run of any length in a bounded number of stretches of time, for plotting. When all
// stretches are in use, their length is doubled, and neighbours are joined.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace clearance {

// Each stretch has a Head and a row of Cells. Head::begin_ns is the time of the first entry, and
// each Cell begins as Cell{}. Head and Cell each need a function merge(later, into) in their own
// namespace, which joins two of them when stretches are joined.
template <class Head, class Cell>
class Stretches {
 public:
  // Makes at most `most` (at least 2) stretches with `columns` cells each; the first ones are
  // `length_ns` > 0 long.
  Stretches(std::size_t columns, std::size_t most, std::int64_t length_ns)
      : columns_(columns), most_(most), length_ns_(length_ns) {}

  // Adds an entry whose time is not before the last one, and returns the cells of its stretch.
  std::span<Cell> add(const Head& head) {
    for (;; halve()) {
      if (!heads_.empty() && number_of(head) <= number_of(heads_.back())) {
        merge(head, heads_.back());
        break;
      }
      if (heads_.size() < most_) {
        heads_.push_back(head);
        cells_.resize(heads_.size() * columns_);
        break;
      }
    }
    return cells_of(heads_.size() - 1);
  }

  // From now on a stretch has `columns` cells, no fewer than before, and there are at most `most`
  // (at least 2) stretches. The new cells of present stretches are Cell{}.
  void widen(std::size_t columns, std::size_t most) {
    most_ = most;
    while (heads_.size() > most_) halve();
    std::vector<Cell> cells(heads_.size() * columns);
    for (std::size_t i = 0; i < cells_.size(); ++i)
      cells[i / columns_ * columns + i % columns_] = cells_[i];
    cells_ = std::move(cells);
    columns_ = columns;
  }

  [[nodiscard]] const std::vector<Head>& heads() const noexcept { return heads_; }
  [[nodiscard]] std::span<const Cell> cells(std::size_t stretch) const {
    return std::span(cells_).subspan(stretch * columns_, columns_);
  }

 private:
  [[nodiscard]] std::int64_t number_of(const Head& head) const {
    return (head.begin_ns - heads_.front().begin_ns) / length_ns_;
  }
  [[nodiscard]] std::span<Cell> cells_of(std::size_t stretch) {
    return std::span(cells_).subspan(stretch * columns_, columns_);
  }

  void halve() {
    length_ns_ *= 2;
    std::size_t kept = 0;
    for (std::size_t i = 1; i < heads_.size(); ++i) {
      const bool joins = number_of(heads_[i]) == number_of(heads_[kept]);
      const std::span<Cell> from = cells_of(i), into = cells_of(joins ? kept : kept + 1);
      if (joins) {
        merge(heads_[i], heads_[kept]);
        for (std::size_t column = 0; column < columns_; ++column) merge(from[column], into[column]);
      } else {
        heads_[++kept] = heads_[i];
        for (std::size_t column = 0; column < columns_; ++column) into[column] = from[column];
      }
    }
    heads_.resize(kept + 1);
    cells_.resize(heads_.size() * columns_);
  }

  std::size_t columns_, most_;
  std::int64_t length_ns_;
  std::vector<Head> heads_;
  std::vector<Cell> cells_;  // a row per stretch
};

}  // namespace clearance
