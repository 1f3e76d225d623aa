// clearance-bench --report DIR: the thesis's tables, ours and the peers', and error against time as
// a picture, from one run. Pictures need gnuplot.
#pragma once

#include <filesystem>
#include <string>

#include "tools/bench/report/curves.hpp"
#include "tools/bench/report/figures.hpp"

namespace clearance::bench {

// The rows that the report shows, as a --benchmark_filter.
inline constexpr const char* kReportRows =
    "^(tracked/|cold/|batch/|peer/[^/]+/(tracked|cold|interval)/|overlap/|interval/|adjacency/|"
    "variant/"
    "((base|dual|aggressive|consistent|all-facets)/(tracked|cold)|"
    "(base-repeated|moved-before|moved)/tracked|base/interval/[0-9]+)/f)";

// Writes DIR/report.md and DIR/pareto.svg. False, and says so on stderr, when it cannot.
[[nodiscard]] bool write_report(const std::filesystem::path& folder, const Figures& figures);

// The same of whole ticks: DIR/ticks.md, the table, and DIR/ticks.svg, cost against the number of
// pairs, speed and density.
inline constexpr const char* kTickRows = "^(tick|sweep)/";
[[nodiscard]] bool write_tick_report(const std::filesystem::path& folder, const Figures& figures);

// The same of curved bodies and of the thesis's chapter 5: DIR/curved.md and DIR/curved.svg.
inline constexpr const char* kCurvedRows =
    "^(curved|pair|ellipsoids|facet-ball|point)/|^peer/[^/]+/(curved|pair)/";
[[nodiscard]] bool write_curved_report(const std::filesystem::path& folder, const Figures& figures);

// The parts of the reports.
[[nodiscard]] std::string tables(const Figures& figures);
[[nodiscard]] std::string thesis_tables(const Figures& figures);
[[nodiscard]] Picture pareto(const Figures& figures);
[[nodiscard]] std::string tick_tables(const Figures& figures);
[[nodiscard]] Picture tick_curves(const Figures& figures);
[[nodiscard]] std::string pair_tables(const Figures& figures);
[[nodiscard]] std::string chapter5_tables(const Figures& figures);
[[nodiscard]] Picture curved_picture(const Figures& figures);

}  // namespace clearance::bench
