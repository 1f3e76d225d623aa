// Every pair of shapes: how it is answered, how exactly, how fast, and what the peers make of the
// same poses.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "tools/bench/report/cell.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

struct Modes {
  const Figure *tracked, *cold;
  [[nodiscard]] double most(double Figure::*what) const {
    return std::max(tracked->*what, cold->*what);
  }
  [[nodiscard]] double most(const char* counter) const {
    return std::max(tracked->counted(counter), cold->counted(counter));
  }
};

Modes modes_of(const Figures& figures, const std::string& prefix, const KindPair& pair) {
  const auto of = [&](const char* mode) {
    return figures.at(fmt::format("{}{}/{}/{}", prefix, pair.group(), mode, pair.load()));
  };
  return {of("tracked"), of("cold")};
}

std::string error(double value) { return value > 0.0 ? fmt::format("{:.0e}", value) : "0"; }

// "3.6x / 2.7x, 6e-04 (816)": multiples of ours, tracked and cold; the largest error; failures.
std::string against(const Modes& peer, const Modes& ours, bool measures) {
  if (!peer.tracked || !peer.cold) return "-";
  std::string cell = fmt::format("{:.1f}x / {:.1f}x", peer.tracked->ns / ours.tracked->ns,
                                 peer.cold->ns / ours.cold->ns);
  if (measures) cell += ", " + error(peer.most(&Figure::max_error));
  const double failures = peer.most(&Figure::failures);
  return failures > 0.0 ? cell + fmt::format(" ({:.0f})", failures) : cell;
}

bool curved(const KindPair& pair) { return pair.group() == "curved"; }

std::string method(const KindPair& pair) {
  return curved(pair) ? "direction, Newton" : "features, active set";
}

std::string oracle(const KindPair& pair) {
  if (pair.a == "ellipsoid" && pair.b == "ellipsoid") return "50 digits; Wolfe";
  return curved(pair) ? "closed forms; Wolfe" : "exact rationals; Wolfe";
}

struct Peer {
  const char* prefix;
  const char* head;
  bool measures;
};
constexpr Peer kPeers[] = {
    {"peer/fcl/", "FCL, 1e-6", true},
    {"peer/fcl-tight/", "FCL, 1e-12", true},
    {"peer/fcl-gjk/", "FCL, own GJK", true},
    {"peer/bullet/", "Bullet", true},
    {"peer/libccd/", "libccd, yes or no", false},
};

}  // namespace

std::string pair_tables(const Figures& figures) {
  Cells head{"pair", "method",       "oracle", "tracked",
             "cold", "bounds apart", "error",  "not converged"};
  for (const Peer& peer : kPeers) head.emplace_back(peer.head);
  Table table(head);
  double truth_gap = 0.0;
  for (const KindPair& pair : kind_pairs()) {
    const Modes ours = modes_of(figures, "", pair);
    if (!ours.tracked || !ours.cold) continue;
    truth_gap = std::max(truth_gap, ours.most("truth_gap"));
    Cells cells{pair.load(),
                method(pair),
                oracle(pair),
                ns(ours.tracked),
                ns(ours.cold),
                error(ours.most("widest_gap")),
                error(ours.most(&Figure::max_error)),
                fmt::format("{:.0f}", ours.most(&Figure::failures))};
    for (const Peer& peer : kPeers) {
      cells.push_back(against(modes_of(figures, peer.prefix, pair), ours, peer.measures));
    }
    table.row(cells);
  }
  return fmt::format(
      "# Pairs of shapes, and the thesis's chapter 5\n\n"
      "Made by `clearance-bench --curved --report tools/bench/measured`. Times are ns a query of "
      "thread CPU time, the least of three repetitions in random order, poses set from "
      "quaternions included; trust their ratios. Errors are in m.\n\n![error against "
      "time](curved.svg)\n\n## Pairs\n\n"
      "Bodies of 0.1 to 0.5 m pass each other at least 1 cm apart, 2 mm and 5 mrad a step: 40 ways "
      "of 100 steps each. Ours is certified: *bounds apart* is upper - lower at worst, *error* "
      "that "
      "of the distance against Wolfe's method in long doubles, whose own gap is {:.0e} m at most "
      "here (*oracle* names what the tests hold it, or ours, against). A peer's cell: times as "
      "multiples of ours, tracked / cold; the largest error of both; in brackets how many of 4,000 "
      "queries failed (flag, NaN, or wrong by more than 1e-6 m). FCL and Bullet have the same "
      "shapes, not polyhedra around them; Bullet's ellipsoid and truncated cone and all of "
      "libccd's are support functions, as their users write them. - : it has no such shape. libccd "
      "alone has no distance.\n\n{}",
      truth_gap, table.text());
}

}  // namespace clearance::bench
