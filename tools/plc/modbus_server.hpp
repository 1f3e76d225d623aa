// Serves registers by Modbus TCP to several clients from one thread. libmodbus makes the answers.
//
// No client can hold up another one. No call waits for a client, and each has a share of every
// step. A client that sends what is no Modbus, or does not read its answers, is dropped.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <memory>
#include <span>
#include <string>

#include <modbus/modbus.h>

#include "config/cell/plc_settings.hpp"

namespace clearance::plc {

struct ModbusCounts {
  std::uint64_t requests = 0, refused_writes = 0;
  std::uint64_t dropped = 0;      // clients that were dropped
  std::uint64_t turned_away = 0;  // clients that found all places taken
};

class ModbusServer {
 public:
  static constexpr std::size_t kMostClients = 16;

  // Throws std::runtime_error if the port cannot be used; 0 is a free one.
  ModbusServer(const ModbusSettings& settings, std::size_t registers);
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  // "192.168.0.5:502".
  [[nodiscard]] const std::string& address() const noexcept { return address_; }
  [[nodiscard]] const ModbusCounts& counts() const noexcept { return counts_; }
  // All registers from address 0 on. A client gets registers of one call.
  void set(std::span<const std::uint16_t> words);
  // Answers until this time, CLOCK_MONOTONIC.
  void serve_until(std::int64_t end_ns);

 private:
  static constexpr std::size_t kLongestFrame = 260;  // Modbus TCP: a header of 7 bytes, 253 more
  struct Client {
    int socket = -1;
    std::string host, peer;  // "10.0.0.7", "10.0.0.7:50123"
    std::array<std::uint8_t, 2 * kLongestFrame> bytes{};
    std::size_t filled = 0;
    int left = 0;              // requests that are answered in this step
    std::int64_t last_ns = 0;  // of its last request; until then, when it came
    bool has_asked = false;    // a whole request came
    std::string fault = {};    // why it is dropped
  };
  using Clients = std::list<Client>;

  void step(std::int64_t end_ns);
  void accept_client();
  [[nodiscard]] bool make_room(const std::string& host);
  void receive(Client& client);
  void answer(Client& client);
  void answer_frame(Client& client, std::size_t size);
  void refuse(Client& client, int exception);
  void drop_faulty();
  [[nodiscard]] bool may_tell(std::int64_t& told_ns) const;

  std::string address_;
  int listener_ = -1;
  int accepts_left_ = 0;  // in this step
  std::unique_ptr<modbus_t, void (*)(modbus_t*)> modbus_;
  std::unique_ptr<modbus_mapping_t, void (*)(modbus_mapping_t*)> mapping_;
  Clients clients_;
  ModbusCounts counts_;
  std::int64_t told_dropped_ns_ = 0, told_write_ns_ = 0;  // when such a line was last logged
};

}  // namespace clearance::plc
