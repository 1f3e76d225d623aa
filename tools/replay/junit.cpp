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

std::string at(const TickNumber& tick, double time_s, const std::string& what) {
  return fmt::format("{}, {:.3f} s: {}\n", tick.text(), time_s, what);
}

std::string failures_of(const OfflineReplay& replay, const std::string& expectation) {
  std::string texts;
  for (const ReplayFailure& failure : replay.failures) {
    if (failure.expectation == expectation) texts += at(failure.tick, failure.time_s, failure.what);
  }
  return texts;
}

// Cases and how many of them fail.
class Cases {
 public:
  explicit Cases(const std::string& cell) : cell_(marked_up(cell)) {}

  void add(const std::string& name, const std::string& error, const std::string& failures,
           const std::string& least) {
    ++count_;
    text_ += fmt::format("    <testcase classname=\"{}\" name=\"{}\">\n", cell_, marked_up(name));
    if (!error.empty()) text_ += element("error", error + "\n" + failures);
    if (error.empty() && !failures.empty()) {
      ++failed_;
      text_ += element("failure", failures);
    }
    if (!least.empty())
      text_ += fmt::format("      <system-out>{}</system-out>\n", marked_up(least));
    text_ += "    </testcase>\n";
  }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int failed() const { return failed_; }

 private:
  std::string cell_, text_;
  int count_ = 0, failed_ = 0;
};

}  // namespace

std::string write_junit(const std::filesystem::path& file, const std::string& cell,
                        const std::string& name, const OfflineReplay& replay, double took_s) {
  const std::string error = !replay.error.empty()    ? replay.error
                            : !replay.damage.empty() ? replay.damage
                            : replay.stopped         ? "stopped before its end"
                                                     : "";
  Cases cases(cell);
  if (!error.empty()) {
    std::string failures;
    for (const ReplayFailure& failure : replay.failures)
      failures += at(failure.tick, failure.time_s, failure.what);
    cases.add(name, error, failures, "");
  } else {
    cases.add(name, "", failures_of(replay, ""), "");
    for (const ExpectationOutcome& one : replay.expectations) {
      const std::string least =
          one.least.empty() ? "no pair was known" : at(one.tick, one.time_s, one.least);
      cases.add(name + ": " + one.expectation, "", failures_of(replay, one.expectation),
                "least: " + least.substr(0, least.find('\n')));
    }
  }
  std::ofstream out(file);
  out << fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"clearance-replay check\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
      "time=\"{:.3f}\">\n    <properties>\n      <property name=\"ticks\" value=\"{}\"/>\n"
      "      <property name=\"not_judged\" value=\"{}\"/>\n    </properties>\n"
      "{}  </testsuite>\n</testsuites>\n",
      cases.count(), cases.failed(), error.empty() ? 0 : 1, took_s, replay.ticks, replay.not_judged,
      cases.text());
  out.close();
  if (out) return "";
  return fmt::format("cannot write {}: {}", file.string(), std::strerror(errno));
}

}  // namespace clearance
