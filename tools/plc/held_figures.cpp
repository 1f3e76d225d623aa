#include "tools/plc/held_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clearance::plc {
HeldFigures::HeldFigures(std::size_t rows, std::int64_t period_ns)
    : period_ns_(period_ns),
      before_(rows, kInfinite),
      now_(rows, kInfinite),
      shown_(rows, -kInfinite) {}

void HeldFigures::add(MessageKind kind, std::span<const double> values,
                      std::int64_t good_until_ns) {
  for (std::size_t i = 0; i < now_.size(); ++i)
    now_[i] = std::isnan(values[i]) ? -kInfinite : std::min(now_[i], values[i]);
  const auto at = static_cast<std::size_t>(kind);
  good_until_ns_[at] = std::max(good_until_ns_[at], good_until_ns);
  is_there_[at] = true;
  if (kind != MessageKind::kDistances) return;
  failed_ = {};
  has_new_ = true;
}

void HeldFigures::fail(Cause cause, std::int64_t until_ns) {
  (cause == Cause::kOtherDaemon ? other_daemon_ : failed_) = {cause, until_ns};
}

Cause HeldFigures::cause_at(std::int64_t now_ns) const noexcept {
  if (now_ns <= other_daemon_.until_ns) return other_daemon_.cause;
  if (now_ns <= failed_.until_ns) return failed_.cause;
  if (now_ns > good_until_ns_[0])
    return good_until_ns_[0] == 0 ? Cause::kNothingHeard : Cause::kSilent;
  if (needs_separation_ && now_ns > good_until_ns_[1]) return Cause::kNoSeparation;
  const bool is_complete = is_there_[0] && (is_there_[1] || !needs_separation_);
  return is_complete ? Cause::kNone : cause_;
}

void HeldFigures::forget() {
  std::ranges::fill(before_, kInfinite);
  std::ranges::fill(now_, kInfinite);
  std::ranges::fill(shown_, -kInfinite);
  is_there_ = {};
  has_new_ = false;
  next_beat_ns_ = 0;
}

void HeldFigures::step(std::int64_t now_ns) {
  cause_ = cause_at(now_ns);
  if (cause_ != Cause::kNone) return forget();
  for (std::size_t i = 0; i < shown_.size(); ++i) shown_[i] = std::min(before_[i], now_[i]);
  if (!has_new_ || now_ns < next_beat_ns_) return;
  next_beat_ns_ = now_ns + period_ns_;
  heartbeat_ = heartbeat_ == 65535 ? std::uint16_t{1} : static_cast<std::uint16_t>(heartbeat_ + 1);
  before_.swap(now_);
  std::ranges::fill(now_, kInfinite);
  has_new_ = false;
}

}  // namespace clearance::plc
