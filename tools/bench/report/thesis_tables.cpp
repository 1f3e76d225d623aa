// Writes the tables of the thesis in their original shape, with our figures.
#include <fmt/format.h>

#include <sstream>
#include <string>

#include "tools/bench/bodies.hpp"
#include "tools/bench/intervals.hpp"
#include "tools/bench/report/cell.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

std::string both_sizes(int order) { return fmt::format("{}", 2 * even_directions(order).size()); }
std::string ball_name(int order) { return fmt::format("f{}", order); }

std::string against_qp(const Figures& figures, const std::string& mode) {
  Table table({"N1+N2", "DQP3, all facets", "DQP3, neighbours", "ours", "QP", "QP / ours"});
  for (const int order : kOrders) {
    const std::string load = fmt::format("{}/{}", mode, ball_name(order));
    const Figure* ours = figures.at(load);
    const Figure* qp = figures.at(fmt::format("peer/qp/{}", load));
    table.row(
        {both_sizes(order), ns_and_failures(figures.at(fmt::format("variant/all-facets/{}", load))),
         ns_and_failures(figures.at(fmt::format("variant/base/{}", load))), ns_and_failures(ours),
         ns_and_failures(qp), ours && qp ? fmt::format("{:.0f}x", qp->ns / ours->ns) : "-"});
  }
  return table.text();
}

std::string variants(const Figures& figures, const std::string& mode) {
  Table table({"N1+N2", "base", "aggressive", "dual", "consistent", "ours"});
  for (const int order : kOrders) {
    const std::string load = fmt::format("{}/{}", mode, ball_name(order));
    Cells cells{both_sizes(order)};
    for (const char* which : {"base", "aggressive", "dual", "consistent"}) {
      cells.push_back(ns_and_failures(figures.at(fmt::format("variant/{}/{}", which, load))));
    }
    cells.push_back(ns_and_failures(figures.at(load)));
    table.row(cells);
  }
  return table.text();
}

std::string moving(const Figures& figures) {
  Table table(
      {"N1+N2", "repeated: moved before", "poses inside", "once: moving counted", "poses inside"});
  for (const int order : kOrders) {
    const std::string load = fmt::format("/tracked/{}", ball_name(order));
    table.row({both_sizes(order), ns(figures.at(fmt::format("variant/moved-before{}", load))),
               ns(figures.at(fmt::format("variant/base-repeated{}", load))),
               ns(figures.at(fmt::format("variant/moved{}", load))),
               ns(figures.at(fmt::format("variant/base{}", load)))});
  }
  return table.text();
}

// Its table 4.3: microseconds of its iteration on the faster of its two machines, 900 MHz.
struct Then {
  int order;
  double cold_us, tracked_us;
};
constexpr Then kThen[] = {{2, 9.3, 1.6},   {4, 16.4, 1.7},   {6, 21.4, 2.2},    {8, 32.4, 2.8},
                          {10, 31.4, 5.1}, {15, 79.1, 11.6}, {20, 127.4, 14.9}, {30, 329.5, 47.3}};

std::string then_and_now(const Figures& figures) {
  Table table(
      {"N1+N2", "cold: 900 MHz", "here", "speed-up", "tracked: 900 MHz", "here", "speed-up"});
  for (const Then& then : kThen) {
    Cells cells{both_sizes(then.order)};
    const auto add = [&](const char* mode, double then_us) {
      const Figure* now =
          figures.at(fmt::format("variant/all-facets/{}/{}", mode, ball_name(then.order)));
      cells.insert(cells.end(), {fmt::format("{:.0f}", 1e3 * then_us), ns_and_failures(now),
                                 now ? fmt::format("{:.1f}", 1e3 * then_us / now->ns) : "-"});
    };
    add("cold", then.cold_us);
    add("tracked", then.tracked_us);
    table.row(cells);
  }
  return table.text();
}

std::string tracked_and_cold(const Figures& figures) {
  Table table({"N1+N2", "facets: cold", "tracked", "cold / tracked", "vertices: cold", "tracked",
               "cold / tracked"});
  for (const int order : kOrders) {
    Cells cells{both_sizes(order)};
    for (const char* kind : {"f", "v"}) {
      const std::string load = fmt::format("{}{}", kind, order);
      const Figure* cold = figures.at(fmt::format("cold/{}", load));
      const Figure* tracked = figures.at(fmt::format("tracked/{}", load));
      cells.insert(cells.end(),
                   {ns(cold), ns(tracked),
                    cold && tracked ? fmt::format("{:.1f}", cold->ns / tracked->ns) : "-"});
    }
    table.row(cells);
  }
  return table.text();
}

std::string intervals(const Figures& figures) {
  Cells head{"steps"};
  for (const char* load : kIntervalLoads) {
    for (const char* who : {"ours", "base", "fcl-gjk", "bullet", "qp"}) {
      head.push_back(fmt::format("{}: {}", load, who));
    }
  }
  Table table(head);
  for (const int steps : kIntervals) {
    Cells cells{fmt::format("{}", steps)};
    for (const char* load : kIntervalLoads) {
      const std::string name = fmt::format("interval/{}/{}", steps, load);
      for (const char* who : {"", "variant/base/", "peer/fcl-gjk/", "peer/bullet/", "peer/qp/"}) {
        cells.push_back(ns_and_failures(figures.at(fmt::format("{}{}", who, name))));
      }
    }
    table.row(cells);
  }
  return table.text();
}

std::string adjacency(const Figures& figures) {
  Table table({"facets", "facet walk of 3.6.2, us", "wrong", "exact hull of the core, us", "wrong",
               "Qhull, us", "wrong"});
  for (const int order : kOrders) {
    Cells cells{fmt::format("{}", even_directions(order).size())};
    for (const char* who : {"walk", "core", "qhull"}) {
      const Figure* f = figures.at(fmt::format("adjacency/{}/{}", who, ball_name(order)));
      cells.push_back(f ? fmt::format("{:.0f}", 1e-3 * f->ns) : "-");
      cells.push_back(f ? fmt::format("{:.0f}", f->wrong) : "-");
    }
    table.row(cells);
  }
  return table.text();
}

}  // namespace

std::string thesis_tables(const Figures& figures) {
  std::ostringstream out;
  out << "## Table 3.3: against a QP, without tracking\n\n"
      << against_qp(figures, "cold") << "## Table 3.4: against a QP, with tracking\n\n"
      << against_qp(figures, "tracked")
      << "## Table 4.1: variants of the active-set iteration, without tracking\n\n"
      << variants(figures, "cold")
      << "## Table 4.1: variants of the active-set iteration, with tracking\n\n"
      << variants(figures, "tracked") << "## Table 4.2: translation and rotation, tracked\n\n"
      << moving(figures)
      << "## Table 4.3: the thesis's iteration, its faster machine and this one\n\nNanoseconds; "
         "here "
         "the variant all-facets, which moves the bodies within.\n\n"
      << then_and_now(figures) << "The same on this machine, ours:\n\n"
      << tracked_and_cold(figures) << "## Table 4.5: queries between two cold starts\n\n"
      << intervals(figures) << "## Table 4.8: adjacency\n\n"
      << adjacency(figures);
  return out.str();
}

}  // namespace clearance::bench
