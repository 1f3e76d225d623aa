// Writes messages as a daemon does: with the address and the CRC that clients check.
#pragma once

#include <array>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance::test {

template <class Message>
void write_sealed(Participant& participant, dds_entity_t writer, Message& message) {
  std::array<char, 256> topic{};
  check_dds(dds_get_name(dds_get_topic(writer), topic.data(), topic.size()), "naming a topic");
  seal(message, participant.address(topic.data()));
  check_dds(dds_write(writer, &message), "writing");
}

}  // namespace clearance::test
