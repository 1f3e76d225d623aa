// Finds what stays in its place in a frame that moves: in how many of the last pictures had each
// cell of a grid around a link an element?
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

// An axis-aligned box, m.
struct FoundBox {
  Vec3 centre = Vec3::Zero(), size = Vec3::Zero();
};

class PayloadGrid {
 public:
  static constexpr int kSide = 32;        // cells
  static constexpr double kCell = 0.025;  // m
  static constexpr double kHalf = 0.5 * kSide * kCell;
  static constexpr std::uint32_t kMostPictures = 32;

  // `pictures` of at most kMostPictures count. Allocates all memory.
  explicit PayloadGrid(std::uint32_t pictures);

  // Forgets all pictures.
  void clear() noexcept;
  // Begins a picture. The one before stays if it was counted.
  void begin() noexcept;
  // An element of it, from the middle of the grid, m; `came`: its place in the world was free in an
  // earlier picture.
  void add(const Vec3& place, bool came) noexcept;
  // The picture counts from now on.
  void count() noexcept;
  [[nodiscard]] bool is_full() const noexcept { return counted_ >= pictures_; }

  // The largest thing that nearly all counted pictures have at one place, that came there, that
  // ends within the grid and begins within `reach` of its middle, m; after count(). From the middle
  // of the grid. Its cells are those of cells() until the next call.
  [[nodiscard]] std::optional<FoundBox> find(double reach) noexcept;
  [[nodiscard]] std::span<const std::uint16_t> cells() const noexcept { return found_; }
  // True if the present picture has an element in this cell or beside it.
  [[nodiscard]] bool has(std::uint16_t cell) const noexcept {
    return (history_around(cell) & 1U) != 0;
  }
  [[nodiscard]] static Vec3 middle_of(std::uint16_t cell) noexcept;
  // Four of five: noise moves an element to the next cell in some pictures, and a hand hides it.
  [[nodiscard]] static constexpr bool is_nearly_all(std::uint32_t some,
                                                    std::uint32_t pictures) noexcept {
    return some * 5 >= pictures * 4;
  }

 private:
  static constexpr std::size_t kCells = std::size_t{kSide} * kSide * kSide;
  static_assert(kCells <= 1U << 16U);
  // Bit i: the i-th last picture had an element, and one that came.
  struct Cell {
    std::uint32_t had = 0, came = 0;
  };
  // The cells that hang together, while they are found.
  struct Thing {
    std::uint32_t had = 0, came = 0;  // elements of all pictures, by cell
    bool ends = true;                 // within the grid
    double nearest = 2.0 * kHalf;     // to its middle, m
  };

  template <class Use>
  static void for_neighbours(std::uint16_t cell, const Use& use) noexcept;
  [[nodiscard]] static bool is_at_border(std::uint16_t cell) noexcept;
  [[nodiscard]] std::uint32_t history_around(std::uint16_t cell) const noexcept;
  [[nodiscard]] bool stays(std::uint16_t cell) const noexcept;
  [[nodiscard]] Thing collect(std::uint16_t from) noexcept;
  [[nodiscard]] FoundBox box() const noexcept;

  std::uint32_t pictures_, counted_ = 0;
  bool is_counted_ = false;
  std::vector<Cell> cells_;
  std::vector<Vec3> elements_;  // of the present picture
  std::vector<std::uint8_t> visited_;
  std::vector<std::uint16_t> reached_, thing_, found_;
};

}  // namespace clearance
