// Each standing has a function that decides on the next tick; all of them end with the batches that
// the store has chosen, the time of the tick and its deadline.
#include "monitor/loop/tick_partner.hpp"

#include <algorithm>
#include <tuple>

namespace clearance {
namespace {

constexpr std::size_t kWaiting = 256;
// The interval at which a follower looks for a notice or batch that is due.
constexpr std::int64_t kPollNs = 50'000;
// After a sleep that was too long, the thread that hears the partner gets so much time to take in
// what came meanwhile.
constexpr std::int64_t kHearNs = 20'000'000;
// A leader's told time may differ from its own clock by what the delays of notices and the clocks
// of two machines leave. It approaches the clock by this part of the time, which changes ages by as
// little. Clocks that disagree by more are no matter of delays.
constexpr std::int64_t kApproach = 1000;
constexpr std::int64_t kMostApproachedNs = 100'000'000;
// Told times of the leaders of one lineage after another differ by less.
constexpr std::int64_t kLargestStepNs = 100'000'000;
// A tick that begins later than this is told a later time. Its inputs are those that have come
// until then, and stamps 5 ms ahead of the told time are refused (`future_limit_ms`).
constexpr std::int64_t kMostLateNs = 2'500'000;

}  // namespace

// One notice that is a little late is no sign that the leader is gone.
TickPartner::TickPartner(PoseSource& source, Clock& clock, const TickPartnerOptions& options)
    : clock_(clock),
      options_(options),
      store_(source, options.batch),
      began_ns_(clock.monotonic_ns()),
      seed_(options.daemon),
      known_(kKnown),
      heard_(kWaiting),
      notices_(kWaiting),
      tags_(kWaiting) {
  options_.lost_after_ns = std::max(options_.lost_after_ns, 2 * options_.period_ns);
  lineage_ = fresh();
}

bool TickPartner::hear(const TickNotice& notice) noexcept {
  TickNotice* const slot = heard_.back();
  if (slot == nullptr) return false;
  *slot = notice;
  heard_.push();
  return true;
}

// A splitmix64 of the daemon's identity: two daemons do not come to the same lineage.
std::uint64_t TickPartner::fresh() noexcept {
  std::uint64_t value = 0;
  while (value == 0) {
    value = seed_ += 0x9e3779b97f4a7c15U;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9U;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebU;
    value ^= value >> 31;
  }
  return value;
}

void TickPartner::stand(PartnerStanding standing) noexcept {
  if (standing == PartnerStanding::kLeading && standing_ != standing)
    leads_since_ns_ = clock_.monotonic_ns();
  standing_ = standing;
  shown_standing_ = standing;
}

void TickPartner::begin_lineage(std::uint64_t lineage, std::uint64_t before) noexcept {
  lineage_ = lineage;
  before_ = before;
  since_cycle_ = cycle_;
}

void TickPartner::become(std::uint64_t lineage) noexcept {
  becoming_ = lineage;
  shown_becoming_ = lineage;
}

void TickPartner::listen() noexcept {
  for (; const TickNotice* notice = heard_.front(); heard_.pop()) {
    if (!is_possible(*notice)) continue;
    newest_cycle_ = notice->cycle;
    newest_daemon_ = notice->daemon;
    newest_revision_ = notice->revision;
    newest_term_ = notice->term;
    newest_becoming_ = notice->becoming;
    for (const TickFrame& frame : notice->shown()) {
      if (frame.sensor < named_.size()) named_[frame.sensor] = frame.content;
    }
    newest_due_ns_ = notice->due_ns;
    heard_ns_ = clock_.monotonic_ns();
    known_[notice->cycle % kKnown] = *notice;
  }
}

// Notices may be forged. A tick is due in two periods at most, and at most two before the last one.
// Its told time leaps by at most kLargestStepNs. The first notice after a join may state any of the
// last two.
bool TickPartner::is_possible(const TickNotice& notice) noexcept {
  const std::int64_t slack = 2 * options_.period_ns;
  bool is = less(notice.due_ns, clock_.monotonic_ns()) <= slack &&
            notice.has_possible_times(steady_.read(clock_).now_ns);
  if (standing_ == PartnerStanding::kFollowing && notice.cycle >= cycle_) {
    const std::int64_t step = less(ahead_of_own(notice), ahead_of_own_ns_);
    is = is && (has_joined_ || (less(deadline_, notice.due_ns) <= slack &&
                                step >= -kLargestStepNs && step <= kLargestStepNs));
  }
  if (!is) ++refused_notices_;
  return is;
}

std::int64_t TickPartner::ahead_of_own(const TickNotice& notice) noexcept {
  const std::int64_t late = less(clock_.monotonic_ns(), notice.due_ns);
  const std::int64_t own = less(steady_.read(clock_).now_ns, late);
  return less(less(notice.time.now_ns, notice.told_late_ns), own);
}

const TickNotice* TickPartner::known(std::uint64_t cycle) const noexcept {
  const TickNotice& notice = known_[cycle % kKnown];
  return notice.cycle == cycle && notice.daemon == newest_daemon_ ? &notice : nullptr;
}

// Both daemons come to the same answer. The one that took the lead last has the higher term; of two
// that were alone before they met, the older one leads.
bool TickPartner::outranks_this(const TickNotice& notice) const noexcept {
  if (notice.term != term_) return notice.term > term_;
  return std::tie(notice.start_ns, notice.daemon) < std::tie(options_.start_ns, options_.daemon);
}

// The leader's ticks before this one are those of this daemon.
bool TickPartner::continues_here(const TickNotice& notice) const noexcept {
  if (notice.revision != revision_) return false;
  return notice.lineage == lineage_ || (notice.becoming != 0 && notice.becoming == lineage_) ||
         (notice.before == lineage_ && notice.since_cycle == cycle_);
}

std::int64_t TickPartner::decide(std::int64_t deadline, std::uint64_t cycle,
                                 std::uint64_t revision) noexcept {
  using enum PartnerStanding;
  cycle_ = cycle;
  revision_ = revision;
  store_.take_in();
  listen();
  // Ticks that the loop has skipped count: the whole process may have been stopped.
  const std::int64_t late_ns =
      clock_.monotonic_ns() - std::min(deadline, deadline_ + options_.period_ns);
  const bool knows_more = standing_ == kFollowing && known(cycle_) != nullptr;
  const bool is_in_step = standing_ == kLeading || standing_ == kFollowing;
  if (late_ns > options_.period_ns / 2 && partner_present_ && is_in_step && !knows_more)
    hear_out(late_ns);
  if (standing_ == kLeading) yield();
  switch (standing_) {
    case kLeading:
      deadline = lead(deadline);
      break;
    case kFollowing:
      deadline = follow(deadline);
      break;
    default:
      deadline = tick_apart(deadline);
  }
  const bool hears = hears_leader();
  const bool may_ask = hears && may_join() && newest_revision_ == revision_;
  wants_state_ = may_ask && (wants_state_ || has_inputs_of_leader());
  // A daemon that was stopped for long counts lower than its leader: clients would see cycles
  // again.
  const bool counts_lower = hears && newest_cycle_ > cycle_ + 1;
  is_silent_ = standing_ == kStarting || (standing_ == kApart && counts_lower);
  return deadline_ = deadline;
}

// Two passes of the other thread, the second of which began after this call, have taken in
// everything. A tick that is a little late waits no longer than a period: the partner may have
// nothing to say any more.
void TickPartner::hear_out(std::int64_t late_ns) noexcept {
  const std::uint64_t passes = passes_.load(std::memory_order_acquire) + 2;
  const std::int64_t most = std::min(kHearNs, std::max(late_ns, options_.period_ns));
  const std::int64_t end = clock_.monotonic_ns() + most;
  while (passes_.load(std::memory_order_acquire) < passes && clock_.monotonic_ns() < end) {
    clock_.sleep_until(clock_.monotonic_ns() + kPollNs);
    listen();
  }
  store_.take_in();
  listen();
}

// A partner that has ticked on while this daemon could not is followed from this tick on. One that
// this daemon has ticked beside is joined.
void TickPartner::yield() noexcept {
  using enum PartnerStanding;
  const TickNotice* const newest = known(newest_cycle_);
  const bool is_recent = clock_.monotonic_ns() - heard_ns_ < options_.lost_after_ns;
  if (newest == nullptr || heard_ns_ == 0 || !is_recent || !outranks_this(*newest)) return;
  const TickNotice* const next = known(cycle_);
  if (next != nullptr && continues_here(*next)) return stand(kFollowing);
  begin_lineage(fresh(), 0);
  stand(kApart);
}

// The time at which the tick is due, also if it begins up to half a period or 2.5 ms later: a
// follower that had to wait for a notice tells the tick the time that its leader has told it. The
// time goes on from that of the last leader, whatever this machine's clock says.
TickTime TickPartner::own_time(std::int64_t due) noexcept {
  approach_own_clock();
  const TickTime read = steady_.read(clock_);
  const std::int64_t early = due - clock_.monotonic_ns();
  const std::int64_t at_due = read.now_ns + early + ahead_of_own_ns_;
  const std::int64_t most_late = std::min(options_.period_ns / 2, kMostLateNs);
  const std::int64_t now = at_due + std::max<std::int64_t>(0, -most_late - early);
  const std::int64_t told = std::max(now, less(time_.now_ns, -1));
  told_late_ns_ = told - at_due;
  return {told, offset_ns_ + read.clock_offset_ns - own_offset_ns_, report_delay_ns_};
}

// The sum is what the told time, as CLOCK_REALTIME, is ahead of that of this machine.
void TickPartner::approach_own_clock() noexcept {
  const std::int64_t ahead = ahead_of_own_ns_ + offset_ns_ - own_offset_ns_;
  if (ahead > kMostApproachedNs || ahead < -kMostApproachedNs) return;
  const std::int64_t most = options_.period_ns / kApproach;
  ahead_of_own_ns_ -= std::clamp(ahead, -most, most);
}

std::int64_t TickPartner::lead(std::int64_t deadline) noexcept {
  store_.choose_all(false);
  choose_frames(partner_present_ ? FramesWait::kForAnswer : FramesWait::kNot);
  time_ = own_time(deadline);
  if (TickNotice* const notice = notices_.back()) {
    notice->daemon = options_.daemon;
    notice->start_ns = options_.start_ns;
    notice->revision = revision_;
    notice->term = term_;
    notice->lineage = lineage_;
    notice->before = before_;
    notice->since_cycle = since_cycle_;
    notice->becoming = becoming_;
    notice->cycle = cycle_;
    notice->time = time_;
    notice->due_ns = deadline;
    notice->told_late_ns = told_late_ns_;
    notice->count = store_.chosen().size();
    std::ranges::copy(store_.chosen(), notice->inputs.begin());
    notice->frame_count = frame_count_;
    std::copy_n(frames_.begin(), frame_count_, notice->frames.begin());
    notices_.push();
    noticed_.post();
  }
  clock_.sleep_until(deadline);
  return deadline;
}

// While a successor catches up in another thread it uses the frames in use, so that their clouds
// must stay. A daemon that is to join keeps them, too, since the state that it gets rests on them:
// the leader names no other ones meanwhile.
void TickPartner::choose_frames(FramesWait wait) noexcept {
  frame_count_ = 0;
  const std::size_t sensors = options_.frames == nullptr ? 0 : options_.frames->sensors();
  const std::int64_t now = clock_.monotonic_ns();
  const std::int64_t patience =
      wait == FramesWait::kForNotice ? 2 * options_.frame_patience_ns : options_.frame_patience_ns;
  for (std::uint32_t sensor = 0; sensor < sensors; ++sensor) {
    const SensorFrame* frame = wait == FramesWait::kForAnswer && becoming_ == 0
                                   ? options_.frames->awaiting_answer(sensor, revision_)
                                   : options_.frames->newest(sensor, revision_);
    if (frame == nullptr || becoming_ != 0) continue;
    if (waits_[sensor] == 0) waits_[sensor] = now;
    const bool is_ready = wait == FramesWait::kForAnswer
                              ? options_.frames->is_built(sensor, frame->content)
                              : wait == FramesWait::kNot || named_[sensor] == frame->content;
    const bool is_patient = (wait == FramesWait::kForNotice && newest_becoming_ != 0) ||
                            now - waits_[sensor] < patience;
    if (!is_ready && is_patient) continue;
    if (!is_ready) frame = options_.frames->newest(sensor, revision_);
    if (frame == nullptr) continue;
    waits_[sensor] = 0;
    frames_[frame_count_++] = {sensor, frame->content};
    options_.frames->choose(sensor);
  }
}

bool TickPartner::hears_leader() noexcept {
  return heard_ns_ != 0 && clock_.monotonic_ns() - heard_ns_ < lost_after();
}

bool TickPartner::has_frames(const TickNotice& notice) noexcept {
  return std::ranges::all_of(notice.shown(), [this](const TickFrame& frame) {
    return options_.frames != nullptr && frame.sensor < options_.frames->sensors() &&
           becoming_ == 0 && options_.frames->has(frame.sensor, frame.content);
  });
}

// `goes_on`: all ticks so far were those of the leader before, which can follow this daemon if it
// has not ticked this one.
std::int64_t TickPartner::take_the_lead(std::int64_t deadline, bool goes_on) noexcept {
  term_ = std::max(term_, newest_term_) + 1;
  if (goes_on) begin_lineage(fresh(), lineage_);
  stand(PartnerStanding::kLeading);
  return lead(deadline);
}

std::int64_t TickPartner::follow(std::int64_t deadline) noexcept {
  const std::int64_t began = clock_.monotonic_ns();
  for (;;) {
    const TickNotice* const notice = known(cycle_);
    if (notice != nullptr) {
      if (!continues_here(*notice)) return part(deadline);
      if (has_frames(*notice) && store_.choose(notice->used())) return follow(*notice);
    }
    const std::int64_t now = clock_.monotonic_ns();
    const std::int64_t due = notice == nullptr ? deadline : notice->due_ns;
    if (now >= std::max({due, deadline, began}) + options_.period_ns / 2) break;
    clock_.sleep_until(now + kPollNs);
    store_.take_in();
    listen();
  }
  const bool leader_goes_on = known(cycle_) != nullptr || newest_cycle_ > cycle_;
  return leader_goes_on ? part(deadline) : take_the_lead(deadline, true);
}

std::int64_t TickPartner::follow(const TickNotice& notice) noexcept {
  if (notice.lineage != lineage_ && notice.becoming != lineage_) lineage_ = notice.lineage;
  before_ = 0;
  term_ = notice.term;
  for (const TickFrame& frame : notice.shown()) options_.frames->choose(frame.sensor);
  ahead_of_own_ns_ = ahead_of_own(notice);
  offset_ns_ = notice.time.clock_offset_ns;
  own_offset_ns_ = steady_.read(clock_).clock_offset_ns;
  has_joined_ = false;
  time_ = notice.time;
  clock_.sleep_until(notice.due_ns);
  return notice.due_ns;
}

std::int64_t TickPartner::part(std::int64_t deadline) noexcept {
  begin_lineage(fresh(), 0);
  stand(PartnerStanding::kApart);
  return tick_apart(deadline);
}

// In phase with the leader, so that both are again when one has the state of the other.
std::int64_t TickPartner::tick_apart(std::int64_t deadline) noexcept {
  const std::int64_t now = clock_.monotonic_ns();
  const bool is_gone =
      heard_ns_ == 0 ? now - began_ns_ > options_.alone_after_ns : now - heard_ns_ > lost_after();
  if (is_gone) return take_the_lead(deadline, false);
  if (heard_ns_ != 0) {
    const std::int64_t period = options_.period_ns;
    const std::int64_t apart = less(deadline, newest_due_ns_) % period;
    deadline -= apart > period / 2 ? apart - period : apart < -period / 2 ? apart + period : apart;
  }
  store_.choose_all(true);
  choose_frames(hears_leader() && newest_revision_ == revision_ ? FramesWait::kForNotice
                                                                : FramesWait::kNot);
  time_ = own_time(deadline);
  clock_.sleep_until(deadline);
  return deadline;
}

void TickPartner::ticked(const Monitor& monitor) noexcept {
  if (TickTag* const tag = tags_.back()) {
    *tag = {cycle_, lineage_, monitor.checksum(), standing_, !is_silent_};
    tags_.push();
  }
}

bool TickPartner::is_behind() noexcept {
  if (standing_ != PartnerStanding::kFollowing) return false;
  listen();
  const TickNotice* const next = known(cycle_ + 1);
  return next != nullptr && next->due_ns <= clock_.monotonic_ns();
}

// A partner that gets this state follows the present lineage until this daemon ticks it, too.
void TickPartner::successor_begins(bool same_scene) noexcept { become(same_scene ? fresh() : 0); }

void TickPartner::successor_followed() noexcept {
  lineage_ = becoming_ != 0 ? becoming_ : fresh();
  before_ = 0;
  become(0);
}

// The state lacks the batches that this daemon has used while it was apart. If the leader ends
// before it names them, this one uses them again.
void TickPartner::joined(std::uint64_t lineage, std::uint64_t cycle) noexcept {
  store_.begin_again();
  for (std::uint64_t back = 0; back < std::min<std::uint64_t>(kKnown, cycle); ++back) {
    if (const TickNotice* const notice = known(cycle - back)) store_.forget(notice->used());
  }
  lineage_ = lineage;
  before_ = 0;
  has_joined_ = true;
  become(0);
  stand(PartnerStanding::kFollowing);
}

}  // namespace clearance
