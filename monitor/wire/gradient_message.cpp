#include "monitor/wire/gradient_message.hpp"

#include "monitor/wire/to_wire.hpp"

namespace clearance {

GradientMessage::GradientMessage(const Scene& scene) : rows_(gradient_rows(scene)) {
  reserve_sequence(message_->pairs, rows_.rows.size());
  reserve_sequence(message_->alternatives, rows_.rows.size());
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
  TickFields::for_each(ToWire{}, report, *message_);
  message_->publish_ns = publish_ns;
  ToWire{}(Field{"alternatives"}, report.gradients.alternatives, message_->alternatives);
  for (std::size_t r = 0; r < rows_.rows.size(); ++r) {
    const GradientRow& row = rows_.rows[r];
    clearance_msg_PairGradient& to = message_->pairs._buffer[r];
    GradientPairFields::for_each(ToWire{}, report.pairs[row.published], to);
    to.drift = report.gradients.drifts[r];
    for (std::uint32_t i = 0; i < row.end - row.first; ++i) {
      to.joints._buffer[i].rate = report.gradients.rates[row.first + i];
    }
  }
  return *message_;
}

}  // namespace clearance
