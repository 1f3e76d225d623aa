#include "tools/scene/written_cell.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "config/cell/cell_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tools/shared/progress_bar.hpp"

namespace clearance {

int write_text(const std::string& text, const std::filesystem::path& output) {
  std::ofstream stream(output, std::ios::binary);
  stream << text;
  stream.close();
  if (stream) return kOk;
  print(stderr, "{}: cannot be written: {}\n", output.string(), std::strerror(errno));
  return kFailed;
}

int write_cell(const std::string& yaml, const std::string& output) {
  if (const int failed = write_text(yaml, output); failed != kOk) return failed;
  const auto cell = cell_or_errors(read_cell(output, told_on_stderr()));
  if (!cell) return kBadCell;
  print(stdout, "{}: {}\n", output, summary(cell->scene));
  return kOk;
}

std::vector<SampledPair> sample_with_progress(const Scene& scene, SamplingOptions options) {
  ProgressBar bar;
  options.progress = [&bar](double share) { bar.show(share, "joint positions"); };
  return sample_contacts(scene, options);
}

}  // namespace clearance
