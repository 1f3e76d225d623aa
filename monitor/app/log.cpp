#include "monitor/app/log.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <string_view>

namespace clearance {
namespace {

constexpr int kDdsLinesASecond = 5;

// A link that is down makes Cyclone say so at every write. Called from any of its threads.
void log_dds(void*, const dds_log_data_t* message) {
  static std::atomic<std::int64_t> second{0};
  static std::atomic<int> lines{0}, left_out{0};
  const std::int64_t now = dds_time() / DDS_NSECS_IN_SEC;
  if (second.exchange(now) != now) {
    lines = 0;
    if (const int count = left_out.exchange(0))
      spdlog::warn("dds: {} more messages left out", count);
  }
  if (lines.fetch_add(1) >= kDdsLinesASecond) {
    ++left_out;
    return;
  }
  std::string_view text(message->message, message->size);
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  const bool severe = (message->priority & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0;
  spdlog::log(severe ? spdlog::level::err : spdlog::level::warn, "dds: {}", text);
}

}  // namespace

void start_log(const std::string& name, const std::string& level) {
  auto logger = spdlog::stderr_color_mt(name);
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %^%l%$: %v");
  logger->set_level(spdlog::level::from_str(level));
  logger->flush_on(spdlog::level::warn);
  spdlog::set_default_logger(std::move(logger));
}

void route_dds_log() { dds_set_log_sink(log_dds, nullptr); }

}  // namespace clearance
