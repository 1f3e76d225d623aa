// The section `plc` of a cell, for clearance-plc: it says which figure stands in which register,
// and where the program serves them to programmable logic controllers.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// A smaller value is always the safer one. 0 is the safe end of all but lengths.
enum class PlcValue : std::uint8_t {
  kHeartbeat,
  kGood,
  kCause,
  kLayout,
  kRefusedWrites,
  kMisfits,
  kClear,
  kLeastDistance,
  kSpeedScaling,
  kStopMargin
};
enum class PlcQuantity : std::uint8_t { kCount, kFlag, kLength, kShare };

// One row a value. `of_zone` and `of_robot`: it may be that of one zone, or of one robot.
struct PlcValueKey {
  std::string_view key;
  PlcQuantity quantity;
  bool of_zone, of_robot;
};
// In the order of PlcValue.
inline constexpr std::array<PlcValueKey, 10> kPlcValues = {{
    {"heartbeat", PlcQuantity::kCount, false, false},
    {"good", PlcQuantity::kFlag, false, false},
    {"cause", PlcQuantity::kCount, false, false},
    {"layout", PlcQuantity::kCount, false, false},
    {"refused_writes", PlcQuantity::kCount, false, false},
    {"misfits", PlcQuantity::kCount, false, false},
    {"clear", PlcQuantity::kFlag, true, false},
    {"least_distance", PlcQuantity::kLength, false, false},
    {"speed_scaling", PlcQuantity::kShare, true, true},
    {"stop_margin", PlcQuantity::kLength, true, true},
}};

// The types in which a value stands in one register of 16 bits, or in two.
struct PlcTypeKey {
  std::string_view key;
  std::uint8_t registers;
  bool is_float;
  double least, most;  // of a float, the finite ones
};
inline constexpr std::array<PlcTypeKey, 5> kPlcTypes = {{
    {"uint16", 1, false, 0.0, 65535.0},
    {"int16", 1, false, -32768.0, 32767.0},
    {"uint32", 2, false, 0.0, 4294967295.0},
    {"int32", 2, false, -2147483648.0, 2147483647.0},
    {"float32", 2, true, -0x1.fffffep127, 0x1.fffffep127},
}};

// The order of bytes, A the most significant of four; registers of 16 bits have AB or BA.
inline constexpr std::array<std::string_view, 4> kPlcOrders = {"ABCD", "CDAB", "BADC", "DCBA"};

struct PlcUnit {
  std::string_view key;
  PlcQuantity quantity;
  double per_si;    // of these units in a metre, or in the full speed
  double standard;  // scale of whole numbers: a millimetre, or a thousandth of the speed
};
inline constexpr std::array<PlcUnit, 4> kPlcUnits = {{
    {"mm", PlcQuantity::kLength, 1000.0, 1.0},
    {"m", PlcQuantity::kLength, 1.0, 0.001},
    {"percent", PlcQuantity::kShare, 100.0, 0.1},
    {"ratio", PlcQuantity::kShare, 1.0, 0.001},
}};

struct PlcRow {
  PlcValue value = PlcValue::kHeartbeat;
  std::string zone = {}, robot = {};  // at most one; both empty: the least of all, or of none
  std::uint16_t at = 0;               // the address of its first register
  std::uint8_t type = 0;              // index into kPlcTypes
  std::uint8_t unit = 0;              // index into kPlcUnits; of counts and flags without meaning
  double scale = 1.0;                 // one count is this many units

  [[nodiscard]] const PlcValueKey& key() const { return kPlcValues[std::size_t(value)]; }
  [[nodiscard]] const PlcTypeKey& width() const { return kPlcTypes[type]; }
  [[nodiscard]] bool has_unit() const {
    return key().quantity == PlcQuantity::kLength || key().quantity == PlcQuantity::kShare;
  }
  // Returns the number of counts for one metre, or for the full speed.
  [[nodiscard]] double per_si() const { return has_unit() ? kPlcUnits[unit].per_si / scale : 1.0; }
};

struct ModbusSettings {
  std::string host = "127.0.0.1";  // an address of this machine
  std::uint16_t port = 1502;
};

struct MqttSettings {
  std::string host;  // of the broker; empty: no MQTT
  std::uint16_t port = 1883;
  std::string topic = "clearance";  // what all topics begin with
  std::string user;                 // empty: none
  // Absolute; empty: none. Without `ca_file` there is no TLS.
  std::filesystem::path password_file, ca_file, certificate_file, key_file;
};

struct PlcSettings {
  std::int64_t period_ns = 10'000'000;
  std::uint8_t order = 0;    // index into kPlcOrders
  std::vector<PlcRow> rows;  // in ascending order of addresses; always with a heartbeat
  ModbusSettings modbus;
  MqttSettings mqtt;
};

// The settings of a cell without `plc:`.
[[nodiscard]] PlcSettings default_plc(const Scene& scene);

}  // namespace clearance
