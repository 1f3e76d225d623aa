#include "monitor/replay/recorded_run.hpp"

#include <utility>

namespace clearance {
namespace {

constexpr std::int64_t kJustPublishedNs = 100'000'000;

}  // namespace

RecordedRun::RecordedRun(const std::vector<std::filesystem::path>& files,
                         const RecordedRunOptions& options, Use use)
    : reader_(files),
      use_(std::move(use)),
      separations_(options.separations),
      gradients_(options.gradients) {
  if (options.frames) frames_.emplace(files);
  if (options.states) states_.emplace(files);
}

bool RecordedRun::next() {
  const bool is_first = last_cycle_ == 0;
  const std::uint64_t daemon = is_first ? 0 : report().daemon;
  do {
    while (waiting_.empty()) {
      if (!read_one()) return false;
    }
    tick_ = std::move(waiting_.front());
    waiting_.pop_front();
  } while (!is_first && report().daemon != daemon && goes_on(daemon));
  joins_ = tick_.joined != 0 && tick_.joined != joined_;
  if (joins_) joined_ = tick_.joined;
  // A daemon that was started again counts from 1. A partner may go on in its place.
  is_restart_ =
      !joins_ && !is_first && (report().cycle <= last_cycle_ || report().daemon != daemon);
  last_cycle_ = report().cycle;
  own_ns_ = tick_.log_ns;
  return true;
}

// The tick that was read last is of another daemon. It ran beside this one if this one goes on, or
// has just published; one that begins does not.
bool RecordedRun::goes_on(std::uint64_t daemon) {
  if (report().cycle > 1 && tick_.log_ns - own_ns_ < kJustPublishedNs) {
    ++of_others_;
    return true;
  }
  for (std::size_t i = 0;; ++i) {
    while (i == waiting_.size()) {
      if (!read_ahead()) return false;
    }
    if (waiting_[i].report->daemon != daemon) continue;
    ++of_others_;
    return true;
  }
}

// Puts the message into the queue of its kind.
bool RecordedRun::read_one() {
  RecordedMessage message;
  if (!reader_.next(message)) return false;
  read_to_ns_ = message.log_ns;
  if (message.kind == TopicKind::kDistances) {
    Tick tick{.report = {}, .log_ns = message.log_ns, .joined = reader_.joined()};
    if (decoder_.decode(message.cdr, tick.report)) {
      waiting_.push_back(std::move(tick));
    } else {
      ++undecodable_;
    }
  } else if (message.kind == TopicKind::kSeparation) {
    separations_.add(message.cdr, decoder_);
  } else if (message.kind == TopicKind::kGradients) {
    gradients_.add(message.cdr, decoder_);
  } else if (message.kind == TopicKind::kZones) {
    Sample<clearance_msg_ZoneState> zone;
    if (decoder_.decode(message.cdr, zone)) zones_.push_back(*zone);
  } else {
    use_(message);
  }
  return true;
}

const clearance_msg_Separation* RecordedRun::separation() {
  return separations_.of_tick(report().now_ns, [this] { return read_ahead(); });
}

const clearance_msg_Gradients* RecordedRun::gradients() {
  return gradients_.of_tick(report().now_ns, [this] { return read_ahead(); });
}

// A state has the log time of the report after it. The reports of those that are passed are
// damaged.
const clearance_msg_PartnerState* RecordedRun::state() {
  if (!joins_ || !states_) return nullptr;
  while (states_->front() != nullptr && states_->front_ns() < tick_.log_ns) states_->pop();
  if (states_->front() == nullptr || states_->front_ns() != tick_.log_ns) return nullptr;
  state_ = states_->take();
  return &*state_;
}

std::vector<RecordedFrame> RecordedRun::frames() {
  std::vector<RecordedFrame> found;
  if (!frames_) return found;
  for (; const clearance_msg_SensorFrame* const frame = frames_->front(); frames_->pop()) {
    // Behind a state of a partner, cycles may have lower numbers.
    if (frame->cycle > report().cycle || frames_->front_ns() > tick_.log_ns) break;
    found.push_back({frame->cycle, from_wire(*frame)});
  }
  return found;
}

}  // namespace clearance
