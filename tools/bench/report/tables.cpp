#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tools/bench/overlaps.hpp"
#include "tools/bench/report/cell.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

// Time as a multiple of ours, largest error, failures.
std::string against(const Figure* f, const Figure* ours) {
  if (!f || !ours) return "-";
  return fmt::format("{} = {:.1f}x, {:.0e}, {:.0f}", time_of(f->ns), f->ns / ours->ns, f->max_error,
                     f->failures);
}

const char* const kPeers[] = {"fcl", "fcl-tight", "fcl-gjk", "bullet", "qp"};

std::string peers(const Figures& figures, const std::string& mode) {
  Cells head{"", "ours", "error", "failures", "cycles"};
  for (const char* who : kPeers) head.push_back(who);
  head.push_back("libccd, yes or no");
  Table table(head);
  for (const std::string& load : workload_names()) {
    const Figure* ours = figures.at(fmt::format("{}/{}", mode, load));
    if (!ours) continue;
    Cells cells{load, ns(ours), fmt::format("{:.0e}", ours->max_error),
                fmt::format("{:.0f}", ours->failures), fmt::format("{:.2f}", ours->iterations)};
    for (const char* who : kPeers) {
      cells.push_back(against(figures.at(fmt::format("peer/{}/{}/{}", who, mode, load)), ours));
    }
    cells.push_back(ns_and_failures(figures.at(fmt::format("peer/libccd/{}/{}", mode, load))));
    table.row(cells);
  }
  return table.text();
}

// A column for each instruction set that this machine has.
std::string batches(const Figures& figures) {
  std::vector<std::string> sets;
  for (const char* set : {"SCALAR", "SSE4", "NEON", "AVX2", "AVX3"}) {
    if (figures.at(fmt::format("batch/{}/boxes", set))) sets.emplace_back(set);
  }
  Cells head{"", "one by one"};
  head.insert(head.end(), sets.begin(), sets.end());
  head.insert(head.end(), {"one by one / batch", "error", "failures", "evaluated singly"});
  Table table(head);
  for (const std::string& load : workload_names()) {
    const Figure* single = figures.at(fmt::format("batch/single/{}", load));
    const Figure* batch = figures.at(fmt::format("batch/{}", load));
    if (!single || !batch) continue;
    Cells cells{load, ns(single)};
    for (const std::string& set : sets) {
      cells.push_back(ns_and_failures(figures.at(fmt::format("batch/{}/{}", set, load))));
    }
    cells.insert(cells.end(),
                 {fmt::format("{:.1f}", single->ns / batch->ns),
                  fmt::format("{:.0e}", batch->max_error), fmt::format("{:.0f}", batch->failures),
                  fmt::format("{:.1f} %", 100 * batch->counted("single"))});
    table.row(cells);
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
      const std::string load = fmt::format("{}/{}", kind, depth.name);
      const Figure* tracked = figures.at(fmt::format("overlap/tracked/{}", load));
      const Figure* cold = figures.at(fmt::format("overlap/cold/{}", load));
      cells.push_back(tracked && cold
                          ? fmt::format("{:.2f} ({:.2f})", 1e-3 * tracked->ns, 1e-3 * cold->ns)
                          : "-");
      for (const Figure* f : {tracked, cold}) {
        if (f) widest = std::max(widest, f->counted("widest_gap"));
      }
    }
    cells.push_back(widest > 0.0 ? fmt::format("{:.0e}", widest) : "-");
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
      << "## Many pairs at once\n\n512 tracked pairs, ns a pair: single queries one after another, "
         "and "
         "batches by instruction set (AVX3 is AVX-512), without what moves the bodies. "
         "Failures are of 102,400.\n\n"
      << batches(figures)
      << "## Overlapping\n\nHow deep, us a query, tracked and in brackets cold; the columns are "
         "how near the origins are (tools/README.md), the last one how far apart our bounds "
         "are.\n\n"
      << overlaps(figures) << thesis_tables(figures);
  return out.str();
}

}  // namespace clearance::bench
