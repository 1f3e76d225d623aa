// The thesis's chapter 5: §5.1 on its families, Tables 5.1 and 5.2 in their shape.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tools/bench/chapter5/methods.hpp"
#include "tools/bench/chapter5/point_families.hpp"
#include "tools/bench/report/cell.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

std::string error(double value) { return value > 0.0 ? fmt::format("{:.0e}", value) : "0"; }

std::string points(const Figures& figures) {
  Table table({"points", "dominant term, ratio accelerator", "the same, limits as printed",
               "safeguarded Newton"});
  for (const PointFamily& family : kPointFamilies) {
    Cells cells{family.what};
    for (const char* method : {"dominant", "as-printed", "newton"}) {
      const Figure* f = figures.at(fmt::format("point/{}/{}", method, family.name));
      cells.push_back(
          f ? fmt::format("{} ns, {:.1f} ({:.0f}), {}{}", time_of(f->ns), f->iterations,
                          f->counted("most_iterations"), error(f->max_error),
                          f->failures > 0.0 ? fmt::format(", **{:.0f} failed**", f->failures) : "")
            : "-");
    }
    table.row(cells);
  }
  return table.text();
}

struct ThesisRow51 {
  int order;
  const char *x_error, *d_error;
};
constexpr ThesisRow51 kThesis51[] = {{4, "0.651", "0.564"},    {6, "0.417", "0.301"},
                                     {8, "0.242", "0.0961"},   {10, "0.123", "0.0338"},
                                     {15, "0.148", "0.00395"}, {20, "0.127", "0.00843"},
                                     {30, "0.0478", "0.00440"}};

std::string table51(const Figures& figures) {
  Table table({"order", "N1+N2", "x error", "the thesis's", "d error", "the thesis's", "cycles",
               "ns, not tracked", "tracked", "by neighbours: not tracked", "tracked"});
  for (const int order : kOrders) {
    const auto of = [&](const char* how) {
      return figures.at(fmt::format("facet-ball/{}/{}", how, order));
    };
    const Figure* cold = of("cold");
    if (!cold) continue;
    const ThesisRow51* thesis = nullptr;
    for (const ThesisRow51& row : kThesis51) {
      if (row.order == order) thesis = &row;
    }
    table.row({fmt::format("{}", order), fmt::format("{:.0f}", cold->counted("facets")),
               fmt::format("{:.3g}", cold->counted("x_error")), thesis ? thesis->x_error : "-",
               fmt::format("{:.3g}", cold->max_error), thesis ? thesis->d_error : "-",
               fmt::format("{:.0f}", cold->iterations), ns(cold), ns(of("tracked")),
               ns(of("neighbours-cold")), ns(of("neighbours-tracked"))});
  }
  return table.text();
}

// Flops of Table 5.2, at 0.1, 0.5, 1.2955 and 5.
struct ThesisRow52 {
  const char* method;
  std::array<const char*, 4> flops;
};
constexpr ThesisRow52 kThesis52[] = {
    {"alternating", {"37693", "11688", "6818", "3422"}},
    {"facet-balls", {"119034", "121038", "108940", "62899"}},
    {"refinement-4", {"X", "86651", "100107", "68300"}},
    {"refinement-7", {"X", "X", "62943", "86534"}},
    {"hybrid", {"46830", "-", "-", "-"}},
};

Cells separations(const char* first) {
  Cells head{first};
  for (const double d : kSeparations) head.push_back(fmt::format("{}", d));
  return head;
}

std::string table52(const Figures& figures) {
  Cells head = separations("method");
  head.emplace_back("tolerance");
  Table table(head);
  for (const Method& method : methods()) {
    const bool cut = method.most_rounds > 0;
    Cells cells{method.label};
    double d_error = 0.0;
    for (const double d : kSeparations) {
      const Figure* f =
          figures.at(fmt::format("ellipsoids/{}/{}{}", method.name, cut ? "to-1e-4/" : "", d));
      cells.push_back(!f ? "X" : cut ? fmt::format("{} ({:.0f})", ns(f), f->iterations) : ns(f));
      if (f) d_error = std::max(d_error, f->max_error);
    }
    cells.push_back(cut ? "x error < 1e-4" : fmt::format("d error < {:.0e}", 1.1 * d_error));
    table.row(cells);
    for (const ThesisRow52& row : kThesis52) {
      if (std::strcmp(row.method, method.name) != 0) continue;
      Cells flops{"*its flops in Table 5.2*", ""};
      flops.insert(flops.end(), row.flops.begin(), row.flops.end());
      flops.emplace_back("");
      table.row(flops);
    }
  }
  return table.text();
}

// Where a method ends by itself.
std::string ends(const Figures& figures) {
  struct Who {
    const char* name;
    const char* label;
  };
  std::vector<Who> all;
  for (const Method& method : methods()) all.push_back({method.name, method.label});
  all.insert(all.end(), {{"fcl", "FCL (libccd), 1e-6"},
                         {"fcl-tight", "FCL (libccd), 1e-12"},
                         {"fcl-gjk", "FCL, own GJK, 1e-12"},
                         {"bullet", "Bullet, GJK on support functions"}});
  Table table(separations("method"));
  for (const Who& who : all) {
    Cells cells{who.label};
    for (const double d : kSeparations) {
      const Figure* f = figures.at(fmt::format("ellipsoids/{}/{}", who.name, d));
      const Figure* ours = figures.at(fmt::format("ellipsoids/ours/{}", d));
      if (!f || !ours) {
        cells.emplace_back("-");
        continue;
      }
      std::string cell = fmt::format("{} = {:.1f}x", ns(f), f->ns / ours->ns);
      if (f->iterations > 0.0) cell += fmt::format(" ({:.0f})", f->iterations);
      cell += ", " + error(f->max_error);
      if (f->counters.contains("x_error")) cell += ", " + error(f->counted("x_error"));
      cells.push_back(f->failures > 0.0 ? "**" + cell + "**" : cell);
    }
    table.row(cells);
  }
  return table.text();
}

}  // namespace

std::string chapter5_tables(const Figures& figures) {
  return fmt::format(
      "## Chapter 5: point to ellipsoid (§5.1)\n\n1,000 seeded points each: ns, mean and in "
      "brackets "
      "most iterations, the largest error of the distance against 50 digits as a share of the size "
      "(longest semi-axis and how far out p is). Failed: wrong by more than 1e-6 of that.\n\n{}"
      "## Table 5.1: DQP3 on ellipsoid models\n\nThe crossed ellipsoids [1 2 5] and [5 2 1], [4 4 "
      "4] "
      "apart, as facet-balls (§5.3); tracked: B goes round a circle in steps of 0.02. The thesis "
      "looks for its step over all facets.\n\n{}"
      "## Table 5.2: how cost scales with the separation\n\nns and in brackets rounds until "
      "(5.2.1), "
      "the error of both points, is below 1e-4, the rounds having been found beforehand; X: it "
      "never is. What has no rounds runs to its end.\n\n{}"
      "## To the end\n\nEach method until it ends by itself: ns = multiple of ours, rounds or "
      "support "
      "points, error of the distance, (5.2.1). Bold: wrong by more than 1e-6 m, or not "
      "ended.\n\n{}",
      points(figures), table51(figures), table52(figures), ends(figures));
}

}  // namespace clearance::bench
