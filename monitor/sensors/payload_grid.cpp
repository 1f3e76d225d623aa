#include "monitor/sensors/payload_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace clearance {
namespace {

// Nearly all pictures have an element in a cell or beside it, and half of them in the cell itself.
constexpr std::uint32_t kOwnShare = 2;
// Of the elements of a thing, so many have to have come to a free place. What it was beside itself
// in the picture before is not free.
constexpr std::uint32_t kCameShare = 4;
constexpr std::size_t kLeastCells = 6;
constexpr std::size_t kMostElements = 1 << 14;

std::uint32_t ones(std::uint32_t bits) noexcept {
  return static_cast<std::uint32_t>(std::popcount(bits));
}

}  // namespace

PayloadGrid::PayloadGrid(std::uint32_t pictures)
    : pictures_(std::min(pictures, kMostPictures)), cells_(kCells), visited_(kCells) {
  elements_.reserve(kMostElements);
  for (auto* list : {&reached_, &thing_, &found_}) list->reserve(kCells);
}

void PayloadGrid::clear() noexcept {
  std::ranges::fill(cells_, Cell{});
  elements_.clear();
  found_.clear();
  counted_ = 0;
  is_counted_ = false;
}

void PayloadGrid::begin() noexcept {
  for (Cell& cell : cells_) {
    cell.had = is_counted_ ? cell.had << 1U : cell.had & ~1U;
    cell.came = is_counted_ ? cell.came << 1U : cell.came & ~1U;
  }
  elements_.clear();
  is_counted_ = false;
}

void PayloadGrid::add(const Vec3& place, bool came) noexcept {
  const auto along = [&](int axis) {
    return static_cast<int>(std::floor((place[axis] + kHalf) / kCell));
  };
  const int x = along(0), y = along(1), z = along(2);
  if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= kSide) return;
  Cell& cell = cells_[static_cast<std::size_t>((z * kSide + y) * kSide + x)];
  cell.had |= 1U;
  if (came) cell.came |= 1U;
  if (elements_.size() < kMostElements) elements_.push_back(place);
}

void PayloadGrid::count() noexcept {
  is_counted_ = true;
  counted_ = std::min(counted_ + 1, pictures_);
}

Vec3 PayloadGrid::middle_of(std::uint16_t cell) noexcept {
  const Vec3 at(cell % kSide, cell / kSide % kSide, cell / (kSide * kSide));
  return kCell * (at + Vec3::Constant(0.5)) - Vec3::Constant(kHalf);
}

bool PayloadGrid::is_at_border(std::uint16_t cell) noexcept {
  const auto ends = [](int at) { return at == 0 || at == kSide - 1; };
  return ends(cell % kSide) || ends(cell / kSide % kSide) || ends(cell / (kSide * kSide));
}

// The neighbours, and the cell itself.
template <class Use>
void PayloadGrid::for_neighbours(std::uint16_t cell, const Use& use) noexcept {
  const int x = cell % kSide, y = cell / kSide % kSide, z = cell / (kSide * kSide);
  const auto low = [](int at) { return std::max(at - 1, 0); };
  const auto high = [](int at) { return std::min(at + 1, kSide - 1); };
  for (int k = low(z); k <= high(z); ++k)
    for (int j = low(y); j <= high(y); ++j)
      for (int i = low(x); i <= high(x); ++i)
        use(static_cast<std::uint16_t>((k * kSide + j) * kSide + i));
}

std::uint32_t PayloadGrid::history_around(std::uint16_t cell) const noexcept {
  std::uint32_t had = 0;
  for_neighbours(cell, [&](std::uint16_t each) { had |= cells_[each].had; });
  return had;
}

bool PayloadGrid::stays(std::uint16_t cell) const noexcept {
  const std::uint32_t window = ~0U >> (32 - pictures_);
  if (ones(cells_[cell].had & window) * kOwnShare < pictures_) return false;
  return is_nearly_all(ones(history_around(cell) & window), pictures_);
}

// Collects the cells that stay and hang together with this one, over whatever the present picture
// has between them.
PayloadGrid::Thing PayloadGrid::collect(std::uint16_t from) noexcept {
  const std::uint32_t window = ~0U >> (32 - pictures_);
  Thing thing;
  thing_.clear();
  reached_.assign(1, from);
  visited_[from] = 1;
  while (!reached_.empty()) {
    const std::uint16_t cell = reached_.back();
    reached_.pop_back();
    if (is_at_border(cell)) thing.ends = false;
    if (stays(cell)) {
      thing_.push_back(cell);
      thing.nearest = std::min(thing.nearest, middle_of(cell).norm());
      thing.had += ones(cells_[cell].had & window);
      thing.came += ones(cells_[cell].came & window);
    }
    for_neighbours(cell, [&](std::uint16_t each) {
      if (visited_[each] != 0 || ((cells_[each].had & 1U) == 0 && !stays(each))) return;
      visited_[each] = 1;
      reached_.push_back(each);
    });
  }
  return thing;
}

// Around its elements in the present picture, and the middles of its cells that this one hides.
FoundBox PayloadGrid::box() const noexcept {
  Vec3 low = Vec3::Constant(kHalf), high = -low;
  const auto add = [&](const Vec3& at) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  };
  for (const std::uint16_t cell : found_) add(middle_of(cell));
  for (const Vec3& each : elements_) {
    const Vec3 at = ((each + Vec3::Constant(kHalf)) / kCell).array().floor();
    const auto cell = static_cast<std::uint16_t>((at.z() * kSide + at.y()) * kSide + at.x());
    if (std::ranges::binary_search(found_, cell)) add(each);
  }
  return {0.5 * (low + high), high - low};
}

std::optional<FoundBox> PayloadGrid::find(double reach) noexcept {
  std::ranges::fill(visited_, std::uint8_t{0});
  found_.clear();
  for (std::size_t i = 0; i < kCells; ++i) {
    const auto cell = static_cast<std::uint16_t>(i);
    if (visited_[i] != 0 || !stays(cell)) continue;
    const Thing thing = collect(cell);
    const bool came = thing.came * kCameShare >= thing.had;
    if (thing.ends && came && thing.nearest <= reach &&
        thing_.size() >= std::max(kLeastCells, found_.size()))
      found_.swap(thing_);
  }
  if (found_.empty()) return std::nullopt;
  std::ranges::sort(found_);
  return box();
}

}  // namespace clearance
