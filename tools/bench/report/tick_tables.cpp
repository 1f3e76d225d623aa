#include "tools/bench/report/print.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"

namespace clearance::bench {
namespace {

std::string us(double value) {
  return value < 9.95  ? print("%.1f", value)
         : value < 1e5 ? print("%.0f", value)
                       : print("%.2e", value);
}

std::string three(const Figure& f) {
  return us(f.counted("p50_us")) + " / " + us(f.counted("p99.9_us")) + " / " +
         us(f.counted("max_us"));
}

// Median, and as a multiple of ours.
std::string against(const Figure* f, const Figure& ours) {
  if (f == nullptr) return "not run";
  const double median = f->counted("p50_us");
  return us(median) + print(" = %.3gx", median / ours.counted("p50_us"));
}

std::string error(const Figure* f) {
  if (f == nullptr) return "-";
  return print("%.0e (%.0f)", f->counted("max_error"), f->counted("compared"));
}

bool is_ours(const std::string& name) {
  return !name.ends_with("/plain") && !name.ends_with("/fcl");
}

void add_rows(const Figures& figures, const std::string& prefix, Table& table) {
  for (const auto& [name, ours] : figures.rows()) {
    if (!name.starts_with(prefix) || !is_ours(name)) continue;
    const Figure* fcl = figures.at(name + "/fcl");
    table.row({name.substr(prefix.size()), print("%.0f", ours.counted("pairs")), three(ours),
               against(figures.at(name + "/plain"), ours), against(fcl, ours), error(fcl),
               print("%.0f", ours.counted("queries")), print("%.3g", ours.counted("proved")),
               print("%.0f", ours.counted("bytes_per_pair")),
               print("%.1f", ours.counted("start_ms"))});
  }
}

Table head(const char* cell) {
  return Table({cell, "pairs", "tick, median / p99.9 / max us", "plain, median us",
                "FCL's minimum alone, median us", "its error, m (ticks)", "queries", "proved",
                "bytes a pair", "start-up ms"});
}

}  // namespace

std::string tick_tables(const Figures& figures) {
  Table cells = head("cell"), sweeps = head("sweep");
  add_rows(figures, "tick/", cells);
  add_rows(figures, "sweep/", sweeps);
  return "Thread CPU time of one tick; multiples are of our median in the same run. Plain: every "
         "pair evaluated in every tick; not run where that takes seconds. FCL: "
         "DynamicAABBTreeCollisionManager::distance, which gives the minimum over all pairs and "
         "nothing else; its error is against our proved minimum.\n\n" +
         cells.text() +
         "300 bodies, all moving at 1 m/s in a grid of 1 m, but for what the row says: the number "
         "of objects, their speed in m/s, the grid's spacing in m.\n\n" +
         sweeps.text();
}

}  // namespace clearance::bench
