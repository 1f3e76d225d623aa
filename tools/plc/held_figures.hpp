// The figures of the last period, and whether they may be believed: what registers and topics say.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace clearance::plc {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Why the figures are fail-safe. The numbers stand in the register `cause`.
enum class Cause : std::uint8_t {
  kNone = 0,
  kNothingHeard = 1,
  kSilent = 2,
  kOld = 3,
  kClocksDisagree = 4,
  kOtherDaemon = 5,
  kNoNames = 6,
  kNoSeparation = 7,
  kOtherCell = 8,
  kFaulty = 9,
  kHeld = 10,
};
inline constexpr std::array<std::string_view, 11> kCauses = {
    "the figures are good",
    "no report has come since the start",
    "no report has come in the last period",
    "the reports are older than a period",
    "the reports are of a later time than this machine's",
    "another daemon publishes, or the daemon was started again",
    "the names of the cell's zones and robots have not come",
    "no message about scaling and stops has come in the last period",
    "the daemon watches another cell, by its name",
    "a report is corrupt, comes again, or is for another topic, partition or domain",
    "two reports were faulty within an hour; find out why, and start this program again",
};

// A message that the daemon writes in every tick.
enum class MessageKind : std::uint8_t { kDistances, kSeparation };

// Each row holds the least value of the last one to two periods, so that a controller that reads
// once per period misses none. Times are of a monotonic clock, ns.
class HeldFigures {
 public:
  HeldFigures(std::size_t rows, std::int64_t period_ns);

  // A good message of this kind, with a value for each row, or infinity for rows of the other kind.
  // It is good until this time.
  void add(MessageKind kind, std::span<const double> values, std::int64_t good_until_ns);
  // A report that must not be believed. It counts until this time, or until a good one comes. If it
  // is of another daemon, good ones do not count meanwhile: two daemons may take turns.
  void fail(Cause cause, std::int64_t until_ns);
  // Says whether the figures need messages of kSeparation.
  void need_separation(bool is_needed) noexcept { needs_separation_ = is_needed; }
  // To be called several times per period, after the reports that have come until now.
  void step(std::int64_t now_ns);

  [[nodiscard]] Cause cause() const noexcept { return cause_; }
  // Advances by one per period, only while the figures are good. It is 0 before the first time,
  // and goes from 65535 to 1.
  [[nodiscard]] std::uint16_t heartbeat() const noexcept { return heartbeat_; }
  // -infinity while the figures are not good.
  [[nodiscard]] std::span<const double> values() const noexcept { return shown_; }

 private:
  struct Failure {
    Cause cause = Cause::kNone;
    std::int64_t until_ns = 0;
  };
  [[nodiscard]] Cause cause_at(std::int64_t now_ns) const noexcept;
  void forget();

  std::int64_t period_ns_;
  std::vector<double> before_, now_, shown_;  // by row: the period before, this one, both
  // By kind: until when its last good message counts, and whether one came since forget().
  std::array<std::int64_t, 2> good_until_ns_{};
  std::array<bool, 2> is_there_{};
  Failure failed_, other_daemon_;
  std::int64_t next_beat_ns_ = 0;
  bool needs_separation_ = false;
  bool has_new_ = false;  // a good report came since the last beat
  Cause cause_ = Cause::kNothingHeard;
  std::uint16_t heartbeat_ = 0;
};

}  // namespace clearance::plc
