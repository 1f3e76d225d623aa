#include "monitor/files/chained_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "config/text/file_bytes.hpp"
#include "config/text/sha256.hpp"

namespace clearance {
namespace {

constexpr std::size_t kHashDigits = 64;

// Walks through a line from its front.
class Cursor {
 public:
  explicit Cursor(std::string_view line) : rest_(line) {}
  bool skip(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  bool read(std::uint64_t& number) {
    const char* const to = rest_.data() + rest_.size();
    const auto [end, error] = std::from_chars(rest_.data(), to, number);
    if (error != std::errc()) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }
  // Reads up to the next quotation mark and over it.
  bool read(std::string_view& text) {
    const std::size_t end = rest_.find('"');
    if (end == std::string_view::npos) return false;
    text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return true;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// Nothing: it is not of the form that next_line() writes, or has not the hash of its content.
std::optional<ChainedLine> parse(std::string_view line) {
  constexpr std::string_view kHash = R"(,"hash":")", kEnd = R"("})";
  if (line.size() < kHash.size() + kHashDigits + kEnd.size() || !line.ends_with(kEnd))
    return std::nullopt;
  const std::size_t content = line.size() - kHash.size() - kHashDigits - kEnd.size();
  if (line.substr(content, kHash.size()) != kHash) return std::nullopt;
  ChainedLine read;
  read.hash = line.substr(content + kHash.size(), kHashDigits);
  Cursor at(line.substr(0, content));
  const bool is_good = at.skip(R"({"number":)") && at.read(read.number) &&
                       at.skip(R"(,"time":")") && at.read(read.time) && at.skip(R"(,"before":")") &&
                       at.read(read.before) && at.skip(R"(,"kind":")") && at.read(read.kind) &&
                       (at.rest().empty() || at.skip(","));
  if (!is_good || sha256(line.substr(0, content)) != read.hash) return std::nullopt;
  read.fields = at.rest();
  return read;
}

// The sound lines of a log, by number: the place of the first one that has it.
using Places = std::map<std::uint64_t, std::size_t>;

template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  for (std::size_t place = 1; !text.empty(); ++place) {
    const std::size_t end = text.find('\n');
    visit(place, text.substr(0, end));
    text.remove_prefix(end + 1);
  }
}

// Why this line does not follow `end`; empty: it does.
std::string break_at(std::size_t place, const ChainedLine& line, const ChainEnd& end,
                     const Places& places) {
  const std::uint64_t expected = end.number + 1;
  if (line.number == expected) {
    if (line.before == end.hash) return {};
    return fmt::format(
        "line {} follows a line with the hash {}; expected {}, that of the line before, which was "
        "written anew",
        place, line.before, end.hash);
  }
  const std::string found =
      fmt::format("line {} has the number {}; expected {}", place, line.number, expected);
  if (line.number < expected)
    return found + fmt::format(", since line {} has that number: it was inserted or moved",
                               places.at(line.number));
  if (const auto later = places.find(expected); later != places.end())
    return found + fmt::format(", which stands in line {}: lines were moved", later->second);
  const std::uint64_t missing = line.number - expected;
  return found + fmt::format(": {} in front of it {} removed",
                             missing == 1 ? "a line" : fmt::format("{} lines", missing),
                             missing == 1 ? "was" : "were");
}

}  // namespace

std::string next_line(ChainEnd& end, std::int64_t time_ns, std::string_view kind,
                      std::string_view fields) {
  const std::chrono::sys_time<std::chrono::microseconds> time(
      std::chrono::floor<std::chrono::microseconds>(std::chrono::nanoseconds(time_ns)));
  const auto second = std::chrono::floor<std::chrono::seconds>(time);
  std::string line =
      fmt::format(R"({{"number":{},"time":"{:%FT%T}.{:06d}Z","before":"{}","kind":"{}"{}{})",
                  ++end.number, fmt::gmtime(std::chrono::system_clock::to_time_t(second)),
                  (time - second).count(), end.hash, kind, fields.empty() ? "" : ",", fields);
  end.hash = sha256(line);
  return line + fmt::format(",\"hash\":\"{}\"}}\n", end.hash);
}

ChainedLog read_chained_log(const std::filesystem::path& file,
                            const std::function<void(const ChainedLine&)>& visit) {
  ChainedLog log;
  const auto bytes = read_bytes(file.string());
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    log.error = fault->reason;
    return log;
  }
  std::string_view text = std::get<std::string>(bytes);
  const std::size_t whole = text.rfind('\n') + 1;  // 0 if there is no line break
  log.torn = text.substr(whole);
  text = text.substr(0, whole);
  Places places;
  for_each_line(text, [&](std::size_t place, std::string_view line) {
    if (const auto read = parse(line)) places.emplace(read->number, place);
  });
  for_each_line(text, [&](std::size_t place, std::string_view line) {
    const auto read = parse(line);
    if (log.fault.empty()) {
      log.fault = read ? break_at(place, *read, log.end, places)
                       : fmt::format(
                             "line {} has not the hash that it states: it was changed, or "
                             "is no line of this log",
                             place);
    }
    if (!read) return;
    log.end = {read->number, std::string(read->hash)};
    log.kind = read->kind;
    if (visit) visit(*read);
  });
  return log;
}

}  // namespace clearance
