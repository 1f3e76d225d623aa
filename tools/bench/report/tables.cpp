#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tools/bench/bodies.hpp"
#include "tools/bench/intervals.hpp"
#include "tools/bench/overlaps.hpp"
#include "tools/bench/report/print.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

std::string time_of(double ns) { return ns < 10000.0 ? print("%.0f", ns) : print("%.2e", ns); }

std::string ns(const Figure* f) { return f ? time_of(f->ns) : "-"; }

// Time, and how many queries failed if any did.
std::string ns_and_failures(const Figure* f) {
  if (!f) return "-";
  return f->failures > 0.0 ? time_of(f->ns) + print(" (%.0f)", f->failures) : time_of(f->ns);
}

// Time as a multiple of ours, largest error, failures.
std::string against(const Figure* f, const Figure* ours) {
  if (!f || !ours) return "-";
  return print("%s = %.1fx, %.0e, %.0f", time_of(f->ns).c_str(), f->ns / ours->ns, f->max_error,
               f->failures);
}

std::string both_sizes(int order) { return std::to_string(2 * even_directions(order).size()); }
std::string ball_name(int order) { return "f" + std::to_string(order); }

const char* const kPeers[] = {"fcl", "fcl-tight", "fcl-gjk", "bullet", "qp"};

std::string peers(const Figures& figures, const std::string& mode) {
  Cells head{"", "ours", "error", "failures", "cycles"};
  for (const char* who : kPeers) head.push_back(who);
  head.push_back("libccd, yes or no");
  Table table(head);
  for (const std::string& load : workload_names()) {
    const Figure* ours = figures.at(mode + "/" + load);
    if (!ours) continue;
    Cells cells{load, ns(ours), print("%.0e", ours->max_error), print("%.0f", ours->failures),
                print("%.2f", ours->iterations)};
    for (const char* who : kPeers) {
      cells.push_back(against(figures.at("peer/" + (who + ("/" + mode)) + "/" + load), ours));
    }
    cells.push_back(ns_and_failures(figures.at("peer/libccd/" + mode + "/" + load)));
    table.row(cells);
  }
  return table.text();
}

// A column for each instruction set that this machine has.
std::string batches(const Figures& figures) {
  std::vector<std::string> sets;
  for (const char* set : {"SCALAR", "SSE4", "NEON", "AVX2", "AVX3"}) {
    if (figures.at(print("batch/%s/boxes", set))) sets.emplace_back(set);
  }
  Cells head{"", "one by one"};
  head.insert(head.end(), sets.begin(), sets.end());
  head.insert(head.end(), {"one by one / batch", "error", "failures", "asked singly"});
  Table table(head);
  for (const std::string& load : workload_names()) {
    const Figure* single = figures.at("batch/single/" + load);
    const Figure* batch = figures.at("batch/" + load);
    if (!single || !batch) continue;
    Cells cells{load, ns(single)};
    for (const std::string& set : sets) {
      cells.push_back(ns_and_failures(figures.at("batch/" + (set + ("/" + load)))));
    }
    cells.insert(cells.end(), {print("%.1f", single->ns / batch->ns),
                               print("%.0e", batch->max_error), print("%.0f", batch->failures),
                               print("%.1f %%", 100 * batch->counted("single"))});
    table.row(cells);
  }
  return table.text();
}

std::string against_qp(const Figures& figures, const std::string& mode) {
  Table table({"N1+N2", "DQP3, all facets", "DQP3, neighbours", "ours", "QP", "QP / ours"});
  for (const int order : kOrders) {
    const std::string load = mode + "/" + ball_name(order);
    const Figure* ours = figures.at(load);
    const Figure* qp = figures.at("peer/qp/" + load);
    table.row({both_sizes(order), ns_and_failures(figures.at("variant/all-facets/" + load)),
               ns_and_failures(figures.at("variant/base/" + load)), ns_and_failures(ours),
               ns_and_failures(qp), ours && qp ? print("%.0fx", qp->ns / ours->ns) : "-"});
  }
  return table.text();
}

std::string variants(const Figures& figures, const std::string& mode) {
  Table table({"N1+N2", "base", "aggressive", "dual", "consistent", "ours"});
  for (const int order : kOrders) {
    const std::string load = mode + "/" + ball_name(order);
    Cells cells{both_sizes(order)};
    for (const char* which : {"base", "aggressive", "dual", "consistent"}) {
      cells.push_back(ns_and_failures(figures.at("variant/" + (which + ("/" + load)))));
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
    const std::string load = "/tracked/" + ball_name(order);
    table.row({both_sizes(order), ns(figures.at("variant/moved-before" + load)),
               ns(figures.at("variant/base-repeated" + load)),
               ns(figures.at("variant/moved" + load)), ns(figures.at("variant/base" + load))});
  }
  return table.text();
}

// Tracked and, in brackets, cold.
std::string overlaps(const Figures& figures) {
  Cells head{""};
  for (const OverlapDepth& depth : kOverlapDepths) head.emplace_back(depth.name);
  head.emplace_back("widest gap, m");
  Table table(head);
  for (const std::string kind : kOverlapKinds) {
    Cells cells{kind};
    double widest = 0.0;
    for (const OverlapDepth& depth : kOverlapDepths) {
      const std::string load = kind + "/" + depth.name;
      const Figure* tracked = figures.at("overlap/tracked/" + load);
      const Figure* cold = figures.at("overlap/cold/" + load);
      cells.push_back(tracked && cold ? print("%.2f (%.2f)", 1e-3 * tracked->ns, 1e-3 * cold->ns)
                                      : "-");
      for (const Figure* f : {tracked, cold}) {
        if (f) widest = std::max(widest, f->counted("widest_gap"));
      }
    }
    cells.push_back(widest > 0.0 ? print("%.0e", widest) : "-");
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
      const std::string load = kind + std::to_string(order);
      const Figure* cold = figures.at("cold/" + load);
      const Figure* tracked = figures.at("tracked/" + load);
      cells.insert(cells.end(), {ns(cold), ns(tracked),
                                 cold && tracked ? print("%.1f", cold->ns / tracked->ns) : "-"});
    }
    table.row(cells);
  }
  return table.text();
}

std::string intervals(const Figures& figures) {
  Cells head{"steps"};
  for (const char* load : kIntervalLoads) {
    for (const char* who : {"ours", "fcl-gjk", "bullet", "qp"}) {
      head.push_back(print("%s: %s", load, who));
    }
  }
  Table table(head);
  for (const int steps : kIntervals) {
    Cells cells{std::to_string(steps)};
    for (const char* load : kIntervalLoads) {
      const std::string name = "interval/" + std::to_string(steps) + "/" + load;
      for (const char* who : {"", "peer/fcl-gjk/", "peer/bullet/", "peer/qp/"}) {
        cells.push_back(ns_and_failures(figures.at(who + name)));
      }
    }
    table.row(cells);
  }
  return table.text();
}

std::string adjacency(const Figures& figures) {
  Table table({"facets", "walk of 3.6.2, us", "wrong", "exact hull of the core, us", "wrong",
               "Qhull, us", "wrong"});
  for (const int order : kOrders) {
    Cells cells{std::to_string(even_directions(order).size())};
    for (const char* who : {"walk", "core", "qhull"}) {
      const Figure* f = figures.at("adjacency/" + (who + ("/" + ball_name(order))));
      cells.push_back(f ? print("%.0f", 1e-3 * f->ns) : "-");
      cells.push_back(f ? print("%.0f", f->wrong) : "-");
    }
    table.row(cells);
  }
  return table.text();
}

}  // namespace

std::string tables(const Figures& figures) {
  std::ostringstream out;
  out << "# Speed against error\n\nTimes are ns a query of thread CPU time, setting both poses "
         "from "
         "quaternions included, the least of all repetitions of one run; rows run in random order. "
         "Errors are in m. "
         "A number in brackets counts the queries of 4,000 that failed (flag, NaN or error above "
         "1e-6 m); "
         "none is none. f and v are facet-balls and their duals of that order.\n\n"
         "![error against time](pareto.svg)\n\n"
      << "## Tracked, against peers\n\nA peer's cell: ns = times ours, largest error, failures.\n\n"
      << peers(figures, "tracked") << "## Cold, against peers\n\n"
      << peers(figures, "cold")
      << "## Many pairs at once\n\n512 tracked pairs, ns a pair: a loop of single queries, and "
         "batches by instruction set (AVX3 is AVX-512), without what moves the bodies. "
         "Failures are of 102,400.\n\n"
      << batches(figures)
      << "## Overlapping\n\nHow deep, us a query, tracked and in brackets cold; the columns are "
         "how near the origins are (core/OVERLAP.md), the last one how far apart our bounds "
         "are.\n\n"
      << overlaps(figures) << "## Table 3.3: against a QP, without tracking\n\n"
      << against_qp(figures, "cold") << "## Table 3.4: against a QP, with tracking\n\n"
      << against_qp(figures, "tracked")
      << "## Table 4.1: variants of the loop, without tracking\n\n"
      << variants(figures, "cold") << "## Table 4.1: variants of the loop, with tracking\n\n"
      << variants(figures, "tracked") << "## Table 4.2: translation and rotation, tracked\n\n"
      << moving(figures) << "## Table 4.3: tracked and cold over sizes\n\n"
      << tracked_and_cold(figures) << "## Table 4.5: queries between two cold starts\n\n"
      << intervals(figures) << "## Table 4.8: adjacency\n\n"
      << adjacency(figures);
  return out.str();
}

}  // namespace clearance::bench
