#include "monitor/dds/partner_port.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "config/text/sentences.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/inputs/checksum.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/participant/wire_values.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance {
namespace {

// Events without a message are noticed this often.
constexpr std::int64_t kPollNs = 10'000'000;
constexpr std::int64_t kAskAgainNs = 1'000'000'000, kStandAgainNs = 1'000'000'000;
// A daemon does not lead any more if its last notice was heard longer ago than this.
constexpr std::int64_t kLeaderHeardNs = 100'000'000;
// A thread that hears takes no longer from one look to the next, unless it is held up.
constexpr std::int64_t kHeldUpNs = 50'000'000;
// The least delay of notices holds for as long without any.
constexpr std::int64_t kDelayLastsNs = 1'000'000'000;
// Clocks of two machines that are in step (PTP, NTP) differ by less.
constexpr std::int64_t kClockErrorNs = 5'000'000;

// The lead of CLOCK_REALTIME over CLOCK_MONOTONIC.
std::int64_t realtime_less_monotonic() {
  SystemClock clock;
  return clock.realtime_ns() - clock.monotonic_ns();
}

template <class T>
bool take(dds_entity_t reader, Sample<T>& sample, dds_sample_info_t& info) {
  void* pointer = &*sample;
  while (dds_take(reader, &pointer, &info, 1, 1) > 0) {
    if (info.valid_data) return true;
  }
  return false;
}

}  // namespace

std::int64_t LeastDelay::add(std::int64_t delay_ns) noexcept {
  if (++count_ % kWindow == 0) {
    before_ = now_;
    now_ = std::numeric_limits<std::int64_t>::max();
  }
  now_ = std::min(now_, delay_ns);
  return least();
}

PartnerPort::PartnerPort(Participant& participant, const Topics& topics,
                         const DaemonIdentity& identity, TickPartner& ticks)
    : identity_(identity),
      ticks_(ticks),
      lease_(ticks.period_ns()),
      ticks_writer_(participant.writer(TopicKind::kPartnerTicks, topics.partner_ticks,
                                       {.lease_ns = lease_.lease_ns()})),
      states_writer_(participant.writer(TopicKind::kPartnerStates, topics.partner_states)),
      ticks_reader_(participant.partner_reader(TopicKind::kPartnerTicks, topics.partner_ticks)),
      states_reader_(participant.partner_reader(TopicKind::kPartnerStates, topics.partner_states)),
      reports_reader_(participant.partner_reader(TopicKind::kDistances, topics.distances)),
      catalogues_reader_(participant.partner_reader(TopicKind::kCatalogue, topics.catalogue)),
      scenes_writer_(participant.writer(TopicKind::kPartnerScenes, topics.partner_scenes)),
      scenes_reader_(participant.partner_reader(TopicKind::kPartnerScenes, topics.partner_scenes)),
      wait_(participant,
            {ticks_reader_, states_reader_, reports_reader_, catalogues_reader_, scenes_reader_}) {
  reserve_sequence(written_->inputs, kMostTickInputs);
  reserve_sequence(written_->frames, kMaxSensors);
  copy_text(identity.partner, written_->partner);
}

PartnerPort::~PartnerPort() { stop(); }

void PartnerPort::start(Actions actions) {
  actions_ = std::move(actions);
  hearing_ = std::thread([this] { hear(); });
  writing_ = std::thread([this] { write_notices(); });
}

void PartnerPort::stop() {
  stop_ = true;
  wait_.wake();
  ticks_.wake();
  if (hearing_.joinable()) hearing_.join();
  if (writing_.joinable()) writing_.join();
}

std::array<std::thread::native_handle_type, 2> PartnerPort::threads() {
  return {hearing_.native_handle(), writing_.native_handle()};
}

void PartnerPort::write_notices() {
  name_thread("notices");
  while (!stop_) {
    ticks_.wait_for_notice();
    for (; const TickNotice* notice = ticks_.notices().front(); ticks_.notices().pop()) {
      clearance_msg_PartnerTick& out = *written_;
      out.daemon = notice->daemon;
      out.start_ns = notice->start_ns;
      out.scene_revision = notice->revision;
      out.term = notice->term;
      out.lineage = notice->lineage;
      out.before = notice->before;
      out.since_cycle = notice->since_cycle;
      out.becoming = notice->becoming;
      out.cycle = notice->cycle;
      out.now_ns = notice->time.now_ns;
      out.clock_offset_ns = notice->time.clock_offset_ns;
      out.report_delay_ns = notice->time.report_delay_ns;
      out.due_ns = notice->due_ns + realtime_less_monotonic();
      out.told_late_ns = notice->told_late_ns;
      out.inputs._length = static_cast<std::uint32_t>(notice->count);
      for (std::size_t i = 0; i < notice->count; ++i) {
        clearance_msg_TickInput& input = out.inputs._buffer[i];
        copy_text(notice->inputs[i].source.view(), input.source);
        input.sequence_number = notice->inputs[i].sequence_number;
        input.content = notice->inputs[i].content;
      }
      out.frames._length = static_cast<std::uint32_t>(notice->frame_count);
      for (std::size_t i = 0; i < notice->frame_count; ++i)
        out.frames._buffer[i] = {notice->frames[i].sensor, notice->frames[i].content};
      const std::int64_t now_ns = SystemClock().monotonic_ns();
      if (dds_write(ticks_writer_, &out) == DDS_RETCODE_OK) lease_.noticed(now_ns, notice->due_ns);
    }
  }
}

void PartnerPort::hear() {
  name_thread("partner");
  while (!stop_) {
    wait_.wait(kPollNs);
    hear_notices();
    ticks_.end_pass();
    hear_states();
    hear_reports();
    hear_scenes();
    hear_catalogues();
    poll();
    look_for_cell();
  }
}

// After a time without any notice, clocks may have drifted apart. If this process was stopped, how
// long notices waited for it says nothing of the clocks: their delay is the one before, or none.
void PartnerPort::hear_notices() {
  dds_sample_info_t info;
  const std::int64_t now = SystemClock().monotonic_ns();
  if (passed_ns_ != 0 && now - passed_ns_ > kHeldUpNs) went_on_ns_ = dds_time();
  passed_ns_ = now;
  is_delay_old_ = is_delay_old_ || now - leader_heard_ns_ > kDelayLastsNs;
  while (take(ticks_reader_, heard_, info)) {
    const std::int64_t sent = info.source_timestamp;
    const std::int64_t before = delay_.is_known() ? delay_.least() : 0;
    const bool waited = sent + before < went_on_ns_;
    if (!waited && std::exchange(is_delay_old_, false)) delay_ = {};
    hear_notice(waited ? before : delay_.add(dds_time() - sent));
  }
}

void PartnerPort::hear_notice(std::int64_t delay_ns) {
  const clearance_msg_PartnerTick& in = *heard_;
  if (delay_.is_settled() && std::abs(delay_ns) > kClockErrorNs &&
      !std::exchange(clock_told_, true))
    log_line(lines::kPartnerClock, in.partner, delay_ns / 1'000'000);
  notice_.daemon = in.daemon;
  notice_.start_ns = in.start_ns;
  notice_.revision = in.scene_revision;
  notice_.term = in.term;
  notice_.lineage = in.lineage;
  notice_.before = in.before;
  notice_.since_cycle = in.since_cycle;
  notice_.becoming = in.becoming;
  notice_.cycle = in.cycle;
  notice_.time = {in.now_ns, in.clock_offset_ns, in.report_delay_ns};
  notice_.due_ns = less(in.due_ns, realtime_less_monotonic() - delay_ns);
  notice_.told_late_ns = in.told_late_ns;
  notice_.count = std::min<std::size_t>(in.inputs._length, kMostTickInputs);
  for (std::size_t i = 0; i < notice_.count; ++i) {
    const clearance_msg_TickInput& input = in.inputs._buffer[i];
    notice_.inputs[i] = {SourceName(input.source), input.sequence_number, input.content};
  }
  notice_.frame_count = std::min<std::size_t>(in.frames._length, kMaxSensors);
  for (std::size_t i = 0; i < notice_.frame_count; ++i)
    notice_.frames[i] = {in.frames._buffer[i].sensor, in.frames._buffer[i].content};
  static_cast<void>(ticks_.hear(notice_));
  leader_ = in.daemon;
  leader_revision_ = in.scene_revision;
  leader_heard_ns_ = SystemClock().monotonic_ns();
}

// A state is for daemons of one build: its bytes have no other layout.
void PartnerPort::hear_states() {
  dds_sample_info_t info;
  while (take(states_reader_, state_, info)) {
    const clearance_msg_PartnerState& in = *state_;
    if (std::strcmp(in.build, kBuild) != 0) {
      if (!std::exchange(refusal_told_, true))
        log_line(lines::kPartnerOtherBuild, in.partner, in.build, kBuild);
      continue;
    }
    if (in.is_request) {
      const bool is_answered = ticks_.standing() == PartnerStanding::kLeading &&
                               !reports_.hears_another(in.partner) && actions_.send_state;
      if (is_answered) actions_.send_state();
      continue;
    }
    const auto state = from_wire(in, kBuild);
    if (state && actions_.take_state) actions_.take_state(*state);
  }
}

void PartnerPort::hear_reports() {
  dds_sample_info_t info;
  while (take(reports_reader_, report_, info)) {
    const bool is_of_one = *report_->partner == '\0' && report_->checksum == 0;
    if (!is_of_one && !has_its_crc(*report_)) {
      reports_.note_corrupt(*report_);
      continue;
    }
    if (*report_->partner == '\0' || identity_.partner == report_->partner) continue;
    partner_revision_ = report_->scene_revision;
    reports_.note_other(*report_);
  }
}

// A latched topic: the last one may come before the first notice.
void PartnerPort::hear_catalogues() {
  dds_sample_info_t info;
  while (take(catalogues_reader_, heard_catalogue_, info)) std::swap(catalogue_, heard_catalogue_);
}

// Likewise. It comes before the catalogue of the scene that it tells of.
void PartnerPort::hear_scenes() {
  dds_sample_info_t info;
  while (take(scenes_reader_, heard_scene_, info)) {
    std::swap(scene_, heard_scene_);
    is_scene_new_ = true;
  }
  const clearance_msg_PartnerScene& its = *scene_;
  const bool is_leaders = its.daemon == leader_ && hears_leader();
  if (is_scene_new_ && is_leaders && actions_.hear_scene) {
    is_scene_new_ = false;
    const auto bytes = std::as_bytes(std::span(its.bytes._buffer, its.bytes._length));
    const bool is_good = its.build != nullptr && std::strcmp(its.build, kBuild) == 0 &&
                         checksum_of(bytes) == its.checksum;
    if (is_good)
      actions_.hear_scene(its);
    else
      scene_->daemon = 0;  // is told by none
  }
  if (actions_.update_lead) actions_.update_lead();
}

bool PartnerPort::hears_leader() const {
  return leader_ != 0 && SystemClock().monotonic_ns() - leader_heard_ns_ < kLeaderHeardNs &&
         ticks_.standing() != PartnerStanding::kLeading;
}

// Whatever changed the leader's cell, and whenever this daemon came: it has that cell, too. It
// takes a cell only with what led to it: a command that is in it is not to be done again.
void PartnerPort::look_for_cell() {
  const std::int64_t now = SystemClock().monotonic_ns();
  if (!hears_leader() || !actions_.take_cell) return;
  const clearance_msg_Catalogue& its = *catalogue_;
  if (its.daemon != leader_ || its.scene_revision != leader_revision_) return;
  if (its.scene_revision == actions_.revision() || !is_told(its.scene_revision)) return;
  if (its.scene_revision == offered_ && now - offered_ns_ < kAskAgainNs) return;
  offered_ = its.scene_revision;
  offered_ns_ = now;
  actions_.take_cell(its.cell_yaml, offered_);
}

// The leader has told what led to its scene of this revision.
bool PartnerPort::is_told(std::uint64_t revision) const {
  const std::span changes(scene_->changes._buffer, scene_->changes._length);
  return scene_->daemon == leader_ && !is_scene_new_ &&
         std::ranges::find(changes, revision, &clearance_msg_SceneChange::scene_revision) !=
             changes.end();
}

void PartnerPort::poll() {
  ticks_.set_partner_present(reports_.hears_any());
  const PartnerStanding standing = ticks_.standing();
  const std::int64_t now = SystemClock().monotonic_ns();
  const std::uint64_t refused = ticks_.refused_notices();
  if (refused > refused_told_ && now - refusal_told_ns_ > kStandAgainNs) {
    log_line(lines::kPartnerNoticeRefused,
             counted(refused - std::exchange(refused_told_, refused), "notice"), partner(),
             refused);
    refusal_told_ns_ = now;
  }
  if (standing != told_ && now - told_ns_ > kStandAgainNs) {
    told_ = standing;
    told_ns_ = now;
    log_line(lines::kPartnerStands, name(standing));
  }
  if (!ticks_.wants_state() || (asked_ns_ != 0 && now - asked_ns_ < kAskAgainNs)) return;
  asked_ns_ = now;
  if (actions_.wants_state) actions_.wants_state();
}

void PartnerPort::write(Sample<clearance_msg_PartnerState> message, const char* what) {
  copy_text(identity_.partner, message->partner);
  message->daemon = identity_.id;
  write(states_writer_, &*message, what);
}

void PartnerPort::request_state(std::uint64_t revision) {
  auto request = to_wire(PartnerStateView{revision, 0, 0, {}}, kBuild);
  request->is_request = true;
  write(std::move(request), "a request to the partner");
}

void PartnerPort::send_state(const PartnerStateView& state) {
  write(to_wire(state, kBuild), "the state for the partner");
}

void PartnerPort::write(dds_entity_t writer, const void* sample, const char* what) {
  const dds_return_t result = dds_write(writer, sample);
  if (result != DDS_RETCODE_OK)
    log_line(lines::kWriteFailed, what, dds_strretcode(result), lines::Count{1});
}

TickTag PartnerPort::tag(std::uint64_t cycle) noexcept {
  while (const TickTag* front = ticks_.tags().front()) {
    const TickTag tag = *front;
    ticks_.tags().pop();
    if (tag.cycle == cycle) return tag;
  }
  return {.cycle = cycle, .standing = ticks_.standing()};
}

void PartnerPort::send_scene(std::span<const clearance_msg_SceneChange> changes,
                             std::span<const std::byte> bytes) {
  Sample<clearance_msg_PartnerScene> sample;
  copy_text(identity_.partner, sample->partner);
  sample->daemon = identity_.id;
  sample->build = dds_string_dup(kBuild);
  reserve_sequence(sample->changes, changes.size());
  std::ranges::copy(changes, sample->changes._buffer);
  sample->changes._length = static_cast<std::uint32_t>(changes.size());
  sample->checksum = checksum_of(bytes);
  reserve_sequence(sample->bytes, bytes.size());
  if (!bytes.empty()) std::memcpy(sample->bytes._buffer, bytes.data(), bytes.size());
  sample->bytes._length = static_cast<std::uint32_t>(bytes.size());
  write(scenes_writer_, &*sample, "a change of the scene for the partner");
}

bool PartnerPort::leads() const {
  return ticks_.standing() == PartnerStanding::kLeading &&
         lease_.holds(SystemClock().monotonic_ns(), ticks_.leads_since_ns()) &&
         writers_alive(ticks_reader_) == 0;
}

void PartnerPort::fill(clearance_msg_PartnerHealth& out) {
  copy_text(identity_.partner, out.partner);
  out.standing = static_cast<std::uint8_t>(ticks_.standing());
  out.leads = leads();
  reports_.fill(out);
}

}  // namespace clearance
