// The shares of a cell that is too large for one machine: each daemon watches the pairs of one.
//
// All ids keep the meaning that they have in the whole cell, but pairs: a scene of one share has
// its own list of pairs, and Shares::own_pairs() leads from an index there to the one in the whole
// cell. DDS has the latter.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

struct Cell;

// The largest number of shares, and the length of their names in bytes.
inline constexpr std::size_t kMaxShares = 64;
inline constexpr std::size_t kMaxShareName = 32;

struct Share {
  std::string name;                  // printable, without '/'
  std::vector<std::uint32_t> pairs;  // ascending: indices into the pairs of the whole cell
  std::vector<std::uint32_t> zones;  // ascending: indices of the zones with a pair of this share
};

struct Shares {
  std::vector<Share> all;            // empty: the cell is not divided
  std::optional<std::uint32_t> own;  // index into `all`: the scene has only the pairs of this one
  std::vector<ObjectPair> pairs;     // with `own`: those of the whole cell
  std::vector<std::uint32_t> separated;  // with `own`: the whole cell's zones with `separation`

  [[nodiscard]] bool is_one() const noexcept { return own.has_value(); }
  // Index into the whole cell's pairs by index into Scene::pairs. Empty if they are the same.
  [[nodiscard]] const std::vector<std::uint32_t>& own_pairs() const noexcept {
    static const std::vector<std::uint32_t> kSame;
    return own ? all[*own].pairs : kSame;
  }
  // The name of the share that the scene has; empty: the whole cell.
  [[nodiscard]] std::string_view name() const noexcept {
    return own ? std::string_view(all[*own].name) : std::string_view();
  }
};

// Reduces a whole cell to one of its shares:
//  - the pairs of the scene, its zones and its contacts are those of the share; a zone without a
//    pair stays, without separation and stops, so that ids stay the same;
//  - objects and joints on which no pair depends are not read (Object::is_read), but for the first
//    share of a cell that takes MoveIt's messages: these may ask for any place;
//  - all topics except inputs are the share's own (topics_of_share);
//  - it answers no questions and writes nothing for ROS 2: both would leave out the pairs of other
//    shares.
void select_share(Cell& cell, std::uint32_t share);

// Costs of a pair for its daemon. The unit is a thousandth of a tracked query of two polyhedra.
// Every tick keeps the bounds of every pair at this cost:
inline constexpr std::uint64_t kKeptCost = 10;
// The cost of one evaluation of the pair. It follows from the cell alone and nothing is measured,
// so all machines divide a cell alike.
[[nodiscard]] std::uint64_t evaluation_cost(const std::vector<Object>& objects,
                                            const ObjectPair& pair) noexcept;
// The expected cost of each pair a tick. A published pair is evaluated in every tick, and any other
// pair is assumed to be evaluated in one of 50.
[[nodiscard]] std::vector<std::uint64_t> expected_costs(const std::vector<Object>& objects,
                                                        const std::vector<ObjectPair>& pairs);

// Divides the pairs, in their order, into `count` runs of about the same cost. Consecutive pairs
// keep the number of first objects of a share small. Returns the first pair of each run after the
// first one, ascending. Equal values mean a run without pairs. `count` is not 0.
[[nodiscard]] std::vector<std::uint32_t> balanced_begins(const std::vector<std::uint64_t>& costs,
                                                         std::uint32_t count);
// Makes shares "1", "2", ... of `pairs` pairs. The first share begins at pair 0, and each further
// one at its entry of `begins`. Does not fill their zones.
[[nodiscard]] std::vector<Share> shares_of_runs(std::size_t pairs,
                                                const std::vector<std::uint32_t>& begins);

// Fills Share::zones. Every pair is in one share.
void note_zones(const std::vector<Zone>& zones, std::vector<Share>& shares);

}  // namespace clearance
