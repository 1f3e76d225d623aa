// A log of interventions for a person: a line each, and whether the chain holds.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/files/chained_log.hpp"
#include "tools/replay/arguments.hpp"

namespace clearance {
namespace {

using nlohmann::ordered_json;

// "text, name: value": a text stands without its quotation marks.
std::string text_of(const ordered_json& fields) {
  std::string text;
  for (const auto& [name, value] : fields.items()) {
    text += text.empty() ? "" : ", ";
    if (name != "text") text += name + ": ";
    text += value.is_string() ? value.get<std::string>() : value.dump();
  }
  return text;
}

}  // namespace

int verify_log(const LogArguments& arguments) {
  std::string before = "stop";  // kind of the line before
  bool holds = arguments.holds.empty();
  const ChainedLog log = read_chained_log(arguments.file, [&](const ChainedLine& line) {
    const auto fields = ordered_json::parse(fmt::format("{{{}}}", line.fields), nullptr, false);
    const bool was_killed =
        line.kind == "start" && before != "stop" && before != "torn" && before != "broken";
    if (was_killed) print(stdout, "        the run before did not end with 'stop'\n");
    print(stdout, "{:6}  {}  {:18} {}\n", line.number, line.time, line.kind,
          fields.is_object() ? text_of(fields) : std::string(line.fields));
    before = line.kind;
    holds = holds || line.hash == arguments.holds;
  });
  const auto fail = [&](const std::string& why) {
    print(stderr, "clearance-replay: {}: {}\n", arguments.file, why);
  };
  if (!log.error.empty()) {
    fail(log.error);
    return kFailed;
  }
  if (!log.fault.empty()) {
    fail(log.fault);
    return kFailed;
  }
  if (!holds) {
    fail(
        fmt::format("no line has the hash {}: lines at the end were cut off, or all lines were "
                    "written anew",
                    arguments.holds));
    return kFailed;
  }
  print(stdout, "{} lines, each as it was written; the last one has the hash {}\n", log.end.number,
        log.end.hash);
  if (!log.torn.empty()) {
    fail(fmt::format("{} bytes behind the last whole line: its program was killed while it wrote",
                     log.torn.size()));
    return kIncomplete;
  }
  if (log.kind != "stop")
    print(stdout,
          "the last line is no 'stop': the daemon still runs, was killed, or lines were cut off\n");
  return kOk;
}

}  // namespace clearance
