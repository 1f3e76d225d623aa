// Datagrams of RTPS 2.1 that bear the name of another program's writer: what a stranger on the
// network can send who has seen its discovery.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "monitor/participant/participant.hpp"

namespace clearance::test {

class ForgedDatagrams {
 public:
  // `writer` is of this process; what is sent bears its name.
  explicit ForgedDatagrams(dds_entity_t writer) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    EXPECT_EQ(dds_get_guid(writer, &guid_), DDS_RETCODE_OK);
  }
  ~ForgedDatagrams() { ::close(socket_); }
  ForgedDatagrams(const ForgedDatagrams&) = delete;
  ForgedDatagrams& operator=(const ForgedDatagrams&) = delete;

  // The sample with this number in the writer's order.
  void data(std::uint32_t number, std::span<const std::byte> cdr) {
    begin();
    begin_submessage(0x15, 0x05);
    put(std::uint16_t{0});
    put(std::uint16_t{16});  // from here to the content
    put(std::uint32_t{0});   // all readers
    put_writer();
    put(std::uint32_t{0});
    put(number);
    bytes_.insert(bytes_.end(), cdr.begin(), cdr.end());
    end_submessage();
  }
  // The writer no longer has samples before this number.
  void heartbeat(std::uint32_t first) {
    begin();
    begin_submessage(0x07, 0x01);
    put(std::uint32_t{0});
    put_writer();
    for (const std::uint32_t number : {0u, first, 0u, first, ++heartbeats_}) put(number);
    end_submessage();
  }
  // The writer's program leaves: its discovery disposes of it.
  void farewell() {
    begin();
    begin_submessage(0x15, 0x0b);  // has parameters, and a key
    put(std::uint16_t{0});
    put(std::uint16_t{16});
    put(htonl(0x0001'00c7));
    put(htonl(0x0001'00c2));
    put(std::uint32_t{0});
    put(++farewells_ + 1'000);
    put(std::uint32_t{0x0004'0071});  // status: disposed and unregistered
    put(htonl(3));
    put(std::uint32_t{1});
    put(std::uint32_t{0x0000'0300});  // a list of parameters, little-endian
    put(std::uint32_t{0x0010'0050});  // the program
    put_prefix();
    put(htonl(0x0000'01c1));
    put(std::uint32_t{1});
    end_submessage();
  }
  // Sends it to every port that a participant of this domain may have.
  void send(std::uint32_t domain) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (std::uint32_t port = 10; port < 30; ++port) {
      to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain + port));
      (void)::sendto(socket_, bytes_.data(), bytes_.size(), MSG_DONTWAIT,
                     reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
  }

 private:
  template <class T>
  void put(T value) {
    const auto* const first = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), first, first + sizeof value);
  }
  void put_prefix() {
    for (int i = 0; i < 12; ++i) put(guid_.v[i]);
  }
  void put_writer() {
    for (int i = 12; i < 16; ++i) put(guid_.v[i]);
  }
  void begin() {
    bytes_.clear();
    put(std::uint32_t{0x5350'5452});  // RTPS
    put(std::uint32_t{0x1001'0102});  // version 2.1, by Eclipse
    put_prefix();
  }
  void begin_submessage(std::uint8_t kind, std::uint8_t flags) {
    put(kind);
    put(flags);
    put(std::uint16_t{0});
    content_ = bytes_.size();
  }
  void end_submessage() {
    const auto size = static_cast<std::uint16_t>(bytes_.size() - content_);
    std::memcpy(bytes_.data() + content_ - sizeof size, &size, sizeof size);
  }

  int socket_;
  dds_guid_t guid_{};
  std::vector<std::byte> bytes_;
  std::size_t content_ = 0;
  std::uint32_t heartbeats_ = 1'000'000, farewells_ = 0;
};

}  // namespace clearance::test
