#include "monitor/wire/gradient_message.hpp"

namespace clearance {

GradientMessage::GradientMessage(const Scene& scene) : rows_(gradient_rows(scene)) {
  reserve_sequence(message_->pairs, rows_.rows.size());
  for (const GradientRow& row : rows_.rows) {
    clearance_msg_PairGradient& pair = message_->pairs._buffer[message_->pairs._length++];
    reserve_sequence(pair.joints, row.end - row.first);
    for (std::uint32_t entry = row.first; entry < row.end; ++entry) {
      pair.joints._buffer[pair.joints._length++].joint = rows_.variables[entry];
    }
  }
}

clearance_msg_Gradients& GradientMessage::of(const Report& report,
                                             std::int64_t publish_ns) noexcept {
  message_->cycle = report.cycle;
  message_->now_ns = report.now_ns;
  message_->publish_ns = publish_ns;
  message_->scene_revision = report.scene_revision;
  for (std::size_t r = 0; r < rows_.rows.size(); ++r) {
    const GradientRow& row = rows_.rows[r];
    const PairReport& from = report.pairs[row.published];
    clearance_msg_PairGradient& to = message_->pairs._buffer[r];
    to.pair = from.pair;
    to.status = static_cast<std::uint8_t>(from.status);
    to.distance = from.distance;
    to.lower = from.lower;
    to.drift = report.gradients.drifts[r];
    for (std::uint32_t i = 0; i < row.end - row.first; ++i) {
      to.joints._buffer[i].rate = report.gradients.rates[row.first + i];
    }
  }
  return *message_;
}

}  // namespace clearance
