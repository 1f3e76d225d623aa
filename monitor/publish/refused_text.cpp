#include "monitor/publish/refused_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

std::string speed_text(const RefusedValue& refused) {
  if (std::isnan(refused.speed)) return {};
  return fmt::format(" at {:.4g} {}", refused.speed, refused.is_joint ? "per s" : "m/s");
}

}  // namespace

std::string text_of(const RefusedValue& refused) {
  const auto& v = refused.value;
  switch (refused.cause) {
    case Reject::kCount:
      return {};
    case Reject::kBackwards:
    case Reject::kFuture:
      return fmt::format("stamped {:.4g} s {}", std::abs(seconds(refused.ahead_ns)),
                         refused.ahead_ns > 0 ? "ahead" : "ago");
    case Reject::kNotUnit:
      return fmt::format("({:.6g}, {:.6g}, {:.6g}, {:.6g})", v[3], v[4], v[5], v[6]);
    default:
      break;
  }
  if (refused.is_joint) return fmt::format("{:.6g}{}", v[0], speed_text(refused));
  std::string turn;
  if (refused.cause == Reject::kNonFinite)
    turn = fmt::format(", quaternion ({:.6g}, {:.6g}, {:.6g}, {:.6g})", v[3], v[4], v[5], v[6]);
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m{}{}", v[0], v[1], v[2], turn, speed_text(refused));
}

}  // namespace clearance
