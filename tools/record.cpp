// clearance-record: writes what is on Clearance's topics, or a pose log kept as CSV, to an MCAP
// file.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "config/cell_file.hpp"
#include "monitor/daemon/dds.hpp"
#include "tools/record/arguments.hpp"

namespace clearance {
namespace {

constexpr const char* kFooter = R"(Exit status:
  0  the recording is complete
  1  it is not, or nothing was heard; the message says why
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined

A pose log has a header line that names t_ns,object,px,py,pz,qw,qx,qy,qz in any order (other columns are
ignored), then a line a pose: poses of the object's frame in the world, m, times in ns, not going back.
With --cell, every object must be in the cell; without, clearance-replay finds them by name.

Examples:
  clearance-record -o run.mcap --cell cell.yaml
  clearance-record -o run.mcap --domain 7 --partition lab --seconds 60
  clearance-record --from-csv poses.csv.gz -o run.mcap --cell cell.yaml)";

int run(int argc, char** argv) {
  CLI::App app("Records every topic of Clearance, as it is on the wire, to an MCAP file.");
  RecordArguments arguments;
  app.add_option("-o,--output", arguments.out, "The recording to write")->required();
  app.add_option("--cell", arguments.cell,
                 "The cell file: domain, partition, topic names, objects");
  CLI::Option* const csv =
      app.add_option("--from-csv", arguments.from_csv, "Make it of this pose log, plain or gzip");
  app.add_option("--seconds", arguments.seconds, "Stop after this long; otherwise on Ctrl-C")
      ->check(CLI::PositiveNumber)
      ->excludes(csv);
  app.add_flag("--overwrite", arguments.overwrite, "Replace the recording if there is one");
  arguments.dds.add_to(app);
  app.footer(kFooter);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  std::error_code not_there;
  if (std::filesystem::equivalent(arguments.from_csv, arguments.out, not_there)) {
    std::fprintf(stderr,
                 "clearance-record: %s is the pose log itself; give another file to write\n",
                 arguments.out.c_str());
    return kUsage;
  }
  if (!arguments.overwrite && std::filesystem::exists(arguments.out)) {
    std::fprintf(stderr, "clearance-record: %s exists; --overwrite replaces it\n",
                 arguments.out.c_str());
    return kFailed;
  }
  CellResult cell = Scene{};
  if (!arguments.cell.empty()) cell = read_cell(arguments.cell);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&cell)) {
    for (const CellError& error : *errors) std::fprintf(stderr, "%s\n", error.text.c_str());
    return kBadCell;
  }
  const Scene* const scene = arguments.cell.empty() ? nullptr : &std::get<Scene>(cell);
  return arguments.from_csv.empty() ? record_from_dds(arguments, scene)
                                    : record_from_csv(arguments, scene);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  try {
    return clearance::run(argc, argv);
  } catch (const clearance::DdsError& error) {
    std::fprintf(stderr, "clearance-record: %s\n", error.what());
    return clearance::kDdsFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "clearance-record: %s\n", error.what());
    return clearance::kFailed;
  }
}
