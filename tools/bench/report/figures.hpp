// The figures of one run of the benchmark, by the names of its rows.
#pragma once

#include <benchmark/benchmark.h>

#include <limits>
#include <map>
#include <string>

namespace clearance::bench {

struct Figure {
  double ns = std::numeric_limits<double>::infinity();  // the least of all repetitions
  double max_error = 0.0;
  double failures = 0.0;
  double iterations = 0.0;
  double facets = 0.0, wrong = 0.0;  // adjacency only
  // All other counters of the row; 0 for those that it does not have.
  std::map<std::string, double> counters;
  [[nodiscard]] double counted(const std::string& name) const {
    const auto found = counters.find(name);
    return found == counters.end() ? 0.0 : found->second;
  }
};

class Figures {
 public:
  // Null where there was no such row.
  [[nodiscard]] const Figure* at(const std::string& name) const {
    const auto found = rows_.find(name);
    return found == rows_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const std::map<std::string, Figure>& rows() const { return rows_; }
  void add(const benchmark::BenchmarkReporter::Run& run);

 private:
  std::map<std::string, Figure> rows_;
};

// Collects the reports of Google Benchmark and shows the progress on stderr.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;
  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  Figures figures_;
};

}  // namespace clearance::bench
