#include "tests/monitor/adversary/lying_partner.hpp"

#include <gtest/gtest.h>

#include "monitor/wire/report_checksum.hpp"

namespace clearance::test::lies {

LyingPartner::LyingPartner(TickLoop& loop, ReportSink& sink)
    : loop_(loop),
      scene_(loop.state().scene()),
      offer_(loop.state(), scene_, {&sink}, records_),
      frames_(scene_.sensors.size()),
      state_(scene_, {.frames = &frames_}) {
  for (std::uint32_t sensor = 0; sensor < frames_.sensors(); ++sensor) {
    const SensorFrame frame = loop.state().monitor().frame_in_use(sensor);
    if (frame.cloud != nullptr) put(sensor, frame);
  }
  EXPECT_TRUE(loop.offer(offer_));
}

const Report* LyingPartner::tick(const Report& of_loop) {
  if (!has_begun_ && offer_.state() == Successor::State::kCatchingUp) {
    std::vector<std::byte> bytes;
    offer_.save(loop_.state().ids(), bytes);
    JoinedState joined(scene_);
    EXPECT_TRUE(joined.restore(bytes, 1));
    EXPECT_TRUE(state_.may_join(joined));
    state_.join(joined);
    has_begun_ = true;
  }
  if (!has_begun_) return nullptr;
  for (const PoseBatch& batch : batches_) static_cast<void>(state_.use(batch));
  batches_.clear();
  const Report& report =
      state_.tick({of_loop.now_ns, of_loop.clock_offset_ns, of_loop.report_delay_ns});
  state_.clear();
  // Until the renewed monitor is in force, the loop has bounds that it has found before.
  const bool is_same_age = offer_.in_force_from() != 0 && report.cycle >= offer_.in_force_from();
  const auto rest = [](const Report& of, const Monitor& monitor) {
    return checksum_of_rest(of, monitor.checksum());
  };
  differs_ =
      is_same_age && (checksum_of(report) != checksum_of(of_loop) ||
                      rest(report, state_.monitor()) != rest(of_loop, loop_.state().monitor()));
  return &report;
}

}  // namespace clearance::test::lies
