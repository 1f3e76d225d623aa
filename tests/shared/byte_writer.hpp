// A writer of any bytes under the name of a type: another program's messages, whole or cut off.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "monitor/participant/participant.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::test {

// Cyclone writes an array of octets as it is. Hence a type of this layout has the given bytes
// behind the header of the encapsulation, and Cyclone checks nothing of them here.
class ByteWriter {
 public:
  // `cdr` begins with the four bytes of the encapsulation, and is what send() writes. `type` gives
  // the name of the type; it says whether messages have keys.
  ByteWriter(Participant& participant, const std::string& partition,
             const dds_topic_descriptor_t& type, const std::string& topic,
             const std::vector<std::byte>& cdr)
      : bytes_(cdr.begin() + 4, cdr.end()) {
    const bool has_key = type.m_nkeys > 0;
    const auto size = static_cast<std::uint32_t>(bytes_.size());
    const std::array<std::uint32_t, 6> operations = {
        std::uint32_t{DDS_OP_ADR} | std::uint32_t{DDS_OP_TYPE_ARR} |
            std::uint32_t{DDS_OP_SUBTYPE_1BY} | (has_key ? DDS_OP_FLAG_KEY : 0u),
        0,
        size,
        DDS_OP_RTS,
        std::uint32_t{DDS_OP_KOF} | 1u,
        0};
    const dds_key_descriptor_t key{"bytes", 4, 0};
    const dds_topic_descriptor_t layout{.m_size = size,
                                        .m_align = 1,
                                        .m_flagset = 0,
                                        .m_nkeys = has_key ? 1u : 0u,
                                        .m_typename = type.m_typename,
                                        .m_keys = has_key ? &key : nullptr,
                                        .m_nops = 2,
                                        .m_ops = operations.data(),
                                        .m_meta = "",
                                        .type_information = {},
                                        .type_mapping = {},
                                        .restrict_data_representation = 0};
    const dds_entity_t same = check_dds(
        dds_create_topic(participant.handle(), &layout, topic.c_str(), nullptr, nullptr), topic);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_partition1(qos, partition.c_str());
    publisher_ = check_dds(dds_create_publisher(participant.handle(), qos, nullptr), topic);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    writer_ = check_dds(dds_create_writer(publisher_, same, qos, nullptr), topic);
    dds_delete_qos(qos);
  }
  ~ByteWriter() { dds_delete(publisher_); }
  ByteWriter(const ByteWriter&) = delete;
  ByteWriter& operator=(const ByteWriter&) = delete;

  [[nodiscard]] bool is_heard() const {
    return eventually([this] { return matched_readers(writer_) > 0; });
  }
  [[nodiscard]] dds_entity_t writer() const noexcept { return writer_; }
  void send() { ASSERT_EQ(dds_write(writer_, bytes_.data()), DDS_RETCODE_OK); }
  // Sends other bytes from now on, as many as before.
  void set(const std::vector<std::byte>& cdr) {
    ASSERT_EQ(cdr.size(), bytes_.size() + 4);
    bytes_.assign(cdr.begin() + 4, cdr.end());
  }

 private:
  std::vector<std::byte> bytes_;
  dds_entity_t publisher_ = 0, writer_ = 0;
};

}  // namespace clearance::test
