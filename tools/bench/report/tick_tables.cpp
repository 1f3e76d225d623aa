#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/report/report.hpp"
#include "tools/bench/report/table.hpp"

namespace clearance::bench {
namespace {

std::string us(double value) {
  return value < 9.95  ? fmt::format("{:.1f}", value)
         : value < 1e5 ? fmt::format("{:.0f}", value)
                       : fmt::format("{:.2e}", value);
}

std::string three(const Figure& f) {
  return fmt::format("{} / {} / {}", us(f.counted("p50_us")), us(f.counted("p99.9_us")),
                     us(f.counted("max_us")));
}

// The time of the ticks themselves: for each tick the least of several runs.
std::string own(const Figure& f) {
  if (f.counted("own_runs") == 0.0) return "-";
  return fmt::format("{} / {} ({:.0f})", us(f.counted("own_p99.9_us")), us(f.counted("own_max_us")),
                     f.counted("own_runs"));
}

// The noise of the machine in plain arithmetic of the same duration.
std::string noise(const Figure& f) {
  return fmt::format("{} / {}", us(f.counted("control_p99.9_us")), us(f.counted("control_max_us")));
}

// Median, and as a multiple of ours.
std::string against(const Figure* f, const Figure& ours) {
  if (f == nullptr) return "not run";
  const double median = f->counted("p50_us");
  return fmt::format("{} = {:.3g}x", us(median), median / ours.counted("p50_us"));
}

std::string error(const Figure* f) {
  if (f == nullptr) return "-";
  return fmt::format("{:.0e} ({:.0f})", f->counted("max_error"), f->counted("compared"));
}

// "tick/NAME" and "sweep/WHAT/VALUE", but not what is compared with them.
bool is_ours(const std::string& name) {
  return name.find("/plain") == std::string::npos && !name.ends_with("/fcl");
}

struct Row {
  std::string name;
  const Figure* ours;
};

// Cells by their number of pairs; sweeps, each by its values, which are the ends of their names.
std::vector<Row> sorted_rows(const Figures& figures, const std::string& prefix) {
  std::vector<Row> rows;
  for (const auto& [name, figure] : figures.rows()) {
    if (name.starts_with(prefix) && is_ours(name)) rows.push_back({name, &figure});
  }
  const auto key = [](const Row& row) {
    const std::size_t end = row.name.rfind('/') + 1;
    const bool sweep = row.name.starts_with("sweep/");
    return sweep ? std::make_pair(row.name.substr(0, end), std::stod(row.name.substr(end)))
                 : std::make_pair(std::string(), row.ours->counted("pairs"));
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const Row& left, const Row& right) { return key(left) < key(right); });
  return rows;
}

// The columns of every row, after those that name the tick.
constexpr const char* kOfATick[] = {"pairs",
                                    "tick, median / p99.9 / max us",
                                    "its own, p99.9 / max us (runs)",
                                    "arithmetic of that median, p99.9 / max us",
                                    "plain, median us",
                                    "FCL's minimum alone, median us",
                                    "its error, m (ticks)",
                                    "queries",
                                    "certified",
                                    "bytes a pair",
                                    "start-up ms"};

Table head(Cells which) {
  which.insert(which.end(), std::begin(kOfATick), std::end(kOfATick));
  return Table(which);
}

void add_row(const Figures& figures, const Row& row, Cells which, Table& table) {
  const Figure& ours = *row.ours;
  const Figure* fcl = figures.at(fmt::format("{}/fcl", row.name));
  for (const std::string& cell :
       {fmt::format("{:.0f}", ours.counted("pairs")), three(ours), own(ours), noise(ours),
        against(figures.at(fmt::format("{}/plain", row.name)), ours), against(fcl, ours),
        error(fcl), fmt::format("{:.0f}", ours.counted("queries")),
        fmt::format("{:.3g}", ours.counted("proved")),
        fmt::format("{:.0f}", ours.counted("bytes_per_pair")),
        fmt::format("{:.1f}", ours.counted("start_ms"))}) {
    which.push_back(cell);
  }
  table.row(which);
}

std::string cells(const Figures& figures) {
  const std::string prefix = "tick/";
  Table table = head({"cell"});
  for (const Row& row : sorted_rows(figures, prefix)) {
    add_row(figures, row, {row.name.substr(prefix.size())}, table);
  }
  return table.text();
}

std::string sweeps(const Figures& figures) {
  const std::string prefix = "sweep/";
  Table table = head({"sweep", "objects", "speed, m/s", "objects a cubic metre"});
  for (const Row& row : sorted_rows(figures, prefix)) {
    const std::string name = row.name.substr(prefix.size());
    add_row(figures, row,
            {name.substr(0, name.find('/')), fmt::format("{:.0f}", row.ours->counted("objects")),
             fmt::format("{:g}", row.ours->counted("speed")),
             fmt::format("{:.3g}", row.ours->counted("density"))},
            table);
  }
  return table.text();
}

}  // namespace

std::string tick_tables(const Figures& figures) {
  return fmt::format(
      "Time of one tick on the wall; multiples are of our median in the same run. Its own: the "
      "same ticks run again, each with the least time that it took in any of the runs; what is "
      "slow in all of them is the tick. Arithmetic: multiplications in registers that take as long "
      "as the median tick, timed as often right after the ticks; what is slow there is the "
      "machine. Plain: every pair evaluated in every tick; not run where that takes seconds. FCL: "
      "DynamicAABBTreeCollisionManager::distance, which gives the minimum over all pairs and "
      "nothing else; its error is against our certified minimum.\n\n{}Bodies in a cubic grid, one "
      "in each of its cells, all moving: 300 at 1 m/s in a grid of 1 m, but for what is "
      "swept.\n\n{}",
      cells(figures), sweeps(figures));
}

}  // namespace clearance::bench
