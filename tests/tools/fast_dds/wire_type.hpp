// A type of Fast DDS that is known by its name only: its samples are the bytes of the wire. Debian
// 12 has Fast DDS 2, Debian 13 has Fast DDS 3, and this header hides how they differ.
#pragma once

#include <fastcdr/Cdr.h>

#include <cstdint>
#include <cstring>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <string>
#include <vector>
#if __has_include(<fastdds/LibrarySettings.hpp>)
#define CLEARANCE_FAST_DDS_3
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#else
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#endif

namespace fdds = eprosima::fastdds::dds;
using Bytes = std::vector<char>;
using Udp = eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using SharedMemory = eprosima::fastdds::rtps::SharedMemTransportDescriptor;

#ifdef CLEARANCE_FAST_DDS_3
namespace rtps = eprosima::fastdds::rtps;
constexpr auto kCdr = eprosima::fastcdr::CdrVersion::DDS_CDR;
constexpr auto kOk = fdds::RETCODE_OK;
inline std::size_t length_of(const eprosima::fastcdr::Cdr& cdr) {
  return cdr.get_serialized_data_length();
}
#else
namespace rtps = eprosima::fastrtps::rtps;
constexpr auto kCdr = eprosima::fastcdr::Cdr::DDS_CDR;
constexpr auto kOk = ReturnCode_t::RETCODE_OK;
inline std::size_t length_of(const eprosima::fastcdr::Cdr& cdr) {
  return cdr.getSerializedDataLength();
}
#endif

class WireType final : public fdds::TopicDataType {
  static constexpr std::uint32_t kLargest = 1 << 20;
  static bool write(const void* data, rtps::SerializedPayload_t& payload) {
    const Bytes& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload.max_size) return false;
    std::memcpy(payload.data, bytes.data(), bytes.size());
    payload.length = static_cast<std::uint32_t>(bytes.size());
    payload.encapsulation = CDR_LE;
    return true;
  }
  static bool read(const rtps::SerializedPayload_t& payload, void* data) {
    const auto* const begin = reinterpret_cast<const char*>(payload.data);
    static_cast<Bytes*>(data)->assign(begin, begin + payload.length);
    return true;
  }
  static std::uint32_t size(const void* data) {
    return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size());
  }

 public:
#ifdef CLEARANCE_FAST_DDS_3
  explicit WireType(const std::string& name) {
    set_name(name);
    max_serialized_type_size = kLargest;
  }
  bool serialize(const void* const data, rtps::SerializedPayload_t& payload,
                 fdds::DataRepresentationId_t) override {
    return write(data, payload);
  }
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) override {
    return read(payload, data);
  }
  std::uint32_t calculate_serialized_size(const void* const data,
                                          fdds::DataRepresentationId_t) override {
    return size(data);
  }
  void* create_data() override { return new Bytes; }
  void delete_data(void* data) override { delete static_cast<Bytes*>(data); }
  bool compute_key(rtps::SerializedPayload_t&, rtps::InstanceHandle_t&, bool) override {
    return false;
  }
  bool compute_key(const void* const, rtps::InstanceHandle_t&, bool) override { return false; }
#else
  explicit WireType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = kLargest;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    return write(data, *payload);
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    return read(*payload, data);
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return size(data); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
#endif
};
