#include "tools/bench/report/figures.hpp"

#include <algorithm>
#include <cstdio>

#include "monitor/app/print.hpp"

namespace clearance::bench {
namespace {

double counter(const benchmark::BenchmarkReporter::Run& run, const char* name) {
  const auto found = run.counters.find(name);
  return found == run.counters.end() ? 0.0 : found->second.value;
}

}  // namespace

void Figures::add(const benchmark::BenchmarkReporter::Run& run) {
  Figure& figure = rows_[run.run_name.function_name];
  figure.ns = std::min(figure.ns, counter(run, "ns"));
  figure.max_error = counter(run, "max_error");
  figure.failures = counter(run, "failures");
  figure.iterations = counter(run, "iterations");
  figure.facets = counter(run, "facets");
  figure.wrong = counter(run, "wrong");
  for (const auto& [name, value] : run.counters) figure.counters[name] = value.value;
}

void Collector::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    figures_.add(run);
    print(stderr, "\r\033[K{}", run.run_name.function_name);
  }
}

}  // namespace clearance::bench
