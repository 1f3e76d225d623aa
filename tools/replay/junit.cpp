#include "tools/replay/junit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>

#include "config/text/printable.hpp"
#include "tools/ask/html.hpp"

namespace clearance {
namespace {

std::string marked_up(const std::string& text) { return escaped(printable(text)); }

std::string element(const char* name, const std::string& text) {
  const std::string first = text.substr(0, text.find('\n'));
  std::string lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines += marked_up(text.substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  return fmt::format("      <{0} message=\"{1}\">{2}</{0}>\n", name, marked_up(first), lines);
}

}  // namespace

std::string write_junit(const std::filesystem::path& file, const std::string& cell,
                        const std::string& name, const OfflineReplay& replay, double took_s) {
  const std::string error = !replay.error.empty()    ? replay.error
                            : !replay.damage.empty() ? replay.damage
                            : replay.stopped         ? "stopped before its end"
                                                     : "";
  std::string failures;
  for (const ReplayFailure& failure : replay.failures)
    failures +=
        fmt::format("{}, {:.3f} s: {}\n", failure.tick.text(), failure.time_s, failure.what);
  const bool fails = error.empty() && !failures.empty();
  std::ofstream out(file);
  out << fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"clearance-replay check\" tests=\"1\" failures=\"{}\" errors=\"{}\" "
      "time=\"{:.3f}\">\n    <properties>\n      <property name=\"ticks\" value=\"{}\"/>\n"
      "      <property name=\"not_judged\" value=\"{}\"/>\n    </properties>\n"
      "    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n",
      fails ? 1 : 0, error.empty() ? 0 : 1, took_s, replay.ticks, replay.not_judged,
      marked_up(cell), marked_up(name), took_s);
  if (!error.empty()) out << element("error", error + "\n" + failures);
  if (fails) out << element("failure", failures);
  out << "    </testcase>\n  </testsuite>\n</testsuites>\n";
  out.close();
  if (out) return "";
  return fmt::format("cannot write {}: {}", file.string(), std::strerror(errno));
}

}  // namespace clearance
