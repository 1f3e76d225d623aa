// The state of a monitor (monitor/tick/saved_state.hpp) as a message: for a partner, and in
// recordings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "monitor/inputs/checksum.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// `cycle`: of the tick after which it was taken. `lineage`: of the ticks that go on from it.
struct PartnerStateView {
  std::uint64_t revision = 0, lineage = 0, cycle = 0;
  std::span<const std::byte> bytes;
};

// `build`: of this program, since its bytes are meant for the same one. `partner` and `daemon` are
// left empty.
[[nodiscard]] inline Sample<clearance_msg_PartnerState> to_wire(const PartnerStateView& state,
                                                                const char* build) {
  Sample<clearance_msg_PartnerState> sample;
  sample->build = dds_string_dup(build);
  sample->scene_revision = state.revision;
  sample->lineage = state.lineage;
  sample->cycle = state.cycle;
  sample->checksum = checksum_of(state.bytes);
  reserve_sequence(sample->bytes, state.bytes.size());
  if (!state.bytes.empty())
    std::memcpy(sample->bytes._buffer, state.bytes.data(), state.bytes.size());
  sample->bytes._length = static_cast<std::uint32_t>(state.bytes.size());
  return sample;
}

// None: it is of another build, or its bytes are not those that were sent.
[[nodiscard]] inline std::optional<PartnerStateView> from_wire(
    const clearance_msg_PartnerState& message, std::string_view build) noexcept {
  const PartnerStateView state{
      message.scene_revision, message.lineage, message.cycle,
      std::as_bytes(std::span(message.bytes._buffer, message.bytes._length))};
  const bool is_whole = message.build != nullptr && build == message.build &&
                        checksum_of(state.bytes) == message.checksum;
  return is_whole ? std::optional(state) : std::nullopt;
}

}  // namespace clearance
