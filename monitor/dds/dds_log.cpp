// Cyclone calls the sink from its own threads, so the rate limit uses atomics instead of a lock.
#include "monitor/dds/dds_log.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>

#include <atomic>
#include <cstdint>
#include <string_view>

#include "monitor/app/log_line.hpp"

namespace clearance {
namespace {

constexpr int kLinesASecond = 5;
// The text of Cyclone's receiving thread about a sample that it cannot decode.
constexpr std::string_view kUndecodable = ": deserialization ";

std::atomic<std::uint64_t> undecodable{0};

// Called by any of Cyclone's threads. When a link is down, Cyclone complains at every write. Lines
// above the rate are counted and left out.
void log_dds(void*, const dds_log_data_t* message) {
  std::string_view text(message->message, message->size);
  if (text.find(kUndecodable) != std::string_view::npos) ++undecodable;
  static std::atomic<std::int64_t> second{0};
  static std::atomic<int> lines{0}, left_out{0};
  const std::int64_t now = dds_time() / DDS_NSECS_IN_SEC;
  if (second.exchange(now) != now) {
    lines = 0;
    if (const int count = left_out.exchange(0))
      log_line(lines::kDdsLeftOut, counted(static_cast<std::uint64_t>(count), "more message"));
  }
  if (lines.fetch_add(1) >= kLinesASecond) {
    ++left_out;
    return;
  }
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  const bool severe = (message->priority & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0;
  log_line(severe ? lines::kDdsError : lines::kDdsWarning, text);
}

}  // namespace

void route_dds_log() { dds_set_log_sink(log_dds, nullptr); }

std::uint64_t undecodable_samples() noexcept { return undecodable.load(); }

}  // namespace clearance
