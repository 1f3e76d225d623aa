#include "monitor/client/complete_reports.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/convex_body.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance::client {
namespace {

// Partners send the same reports, and a lineage is random. Other daemons are told by their number.
std::uint64_t sender_of(const clearance_msg_Distances& message) noexcept {
  return message.lineage != 0 ? message.lineage : message.daemon;
}

// The elements own nothing.
void put(const std::vector<clearance_msg_PairDistance>& pairs, clearance_msg_Distances& message) {
  auto& list = message.pairs;
  if (list._maximum < pairs.size()) {
    if (list._release) dds_free(list._buffer);
    reserve_sequence(list, pairs.size());
  }
  std::ranges::copy(pairs, list._buffer);
  list._length = static_cast<std::uint32_t>(pairs.size());
}

}  // namespace

clearance_msg_PairDistance unknown_pair(std::uint32_t pair) noexcept {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  constexpr clearance_msg_Vector3 kNowhere{kNaN, kNaN, kNaN};
  clearance_msg_PairDistance unknown{};
  unknown.pair = pair;
  unknown.status = static_cast<std::uint8_t>(PairStatus::kUnknown);
  unknown.distance = unknown.closing_speed = unknown.time_to_contact = unknown.model_error = kNaN;
  unknown.lower = unknown.swept_lower = unknown.stop_lower = -kUnbounded;
  unknown.upper = kUnbounded;
  unknown.witness_a = unknown.witness_b = unknown.normal = kNowhere;
  unknown.age_a_ns = unknown.age_b_ns = -1;
  return unknown;
}

// Pairs stand in the order of the cell, which is that of their ids. Behind a gap all are unknown
// but those that a message has had since.
bool CompleteReports::complete(clearance_msg_Distances& message) {
  if (message.changes_since == 0) {  // of a daemon that always sends all
    cycle_ = 0;
    return true;
  }
  const std::uint64_t sender = sender_of(message);
  const bool is_full = message.changes_since == message.cycle;
  const bool is_same = sender == sender_ && message.scene_revision == revision_;
  const bool follows = is_same && message.changes_since == cycle_;
  is_known_ = is_full || (is_known_ && follows);
  cycle_ = message.cycle;
  sender_ = sender;
  const bool is_same_scene = std::exchange(revision_, message.scene_revision) == revision_;
  const auto* const sent = message.pairs._buffer;
  if (is_full) {
    pairs_.assign(sent, sent + message.pairs._length);
    message.changes_since = 0;
    return true;
  }
  if (!is_same_scene) pairs_.clear();
  if (!follows) {
    for (clearance_msg_PairDistance& pair : pairs_) pair = unknown_pair(pair.pair);
  }
  for (std::uint32_t i = 0; i < message.pairs._length; ++i) {
    const auto place =
        std::ranges::lower_bound(pairs_, sent[i].pair, {}, &clearance_msg_PairDistance::pair);
    if (place != pairs_.end() && place->pair == sent[i].pair) {
      *place = sent[i];
    } else {
      pairs_.insert(place, sent[i]);
    }
  }
  put(pairs_, message);
  message.changes_since = 0;
  return is_known_;
}

}  // namespace clearance::client
