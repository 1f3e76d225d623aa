#include "tools/watch/number_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "monitor/interface/age_text.hpp"

namespace clearance::watch {
namespace {

// Right-aligned in all cases: fmt puts NaN and infinity to the left.
std::string aligned(double value, int precision, int width) {
  const std::string text = std::isnan(value) ? "unknown" : fmt::format("{:.{}f}", value, precision);
  return fmt::format("{:>{}}", text, width);
}

}  // namespace

std::string metres(double value) { return aligned(value, 4, 9); }

std::string point(const clearance_msg_Vector3& p) {
  return fmt::format("({} {} {})", aligned(p.x, 3, 7), aligned(p.y, 3, 7), aligned(p.z, 3, 7));
}

std::string contact_time(double seconds) {
  if (std::isnan(seconds)) return "unknown";
  return seconds < 1000.0 ? fmt::format("{:7.2f}", seconds) : "      -";
}

std::string speed(double metres_per_second) {
  return std::isnan(metres_per_second) ? "unknown" : fmt::format("{:+7.3f}", metres_per_second);
}

std::string approach(const clearance_msg_PairDistance& pair) {
  if (std::isnan(pair.closing_speed)) return "closing at an unknown speed";
  return fmt::format("closing {:+.3f} m/s  contact in {} s", pair.closing_speed,
                     contact_time(pair.time_to_contact));
}

std::string precise_age(std::int64_t age_ns) {
  if (age_ns >= kForgottenNs) return age_text(age_ns);
  return fmt::format("{:.2f} ms", 1e-6 * static_cast<double>(age_ns));
}

}  // namespace clearance::watch
