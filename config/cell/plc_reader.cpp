#include "config/cell/plc_reader.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kMostPort = 65535, kMostAddress = 65535;
constexpr double kMostPeriod_ms = 1000.0, kLeastTicks = 2.0;

template <class Table>
std::vector<std::string> keys_of(const Table& table) {
  std::vector<std::string> keys;
  for (const auto& each : table) {
    if constexpr (requires { each.key; })
      keys.emplace_back(each.key);
    else
      keys.emplace_back(each);
  }
  return keys;
}

// Reads one of these words as its place among them.
std::optional<std::size_t> read_word(const YamlNode& node, const std::string& what,
                                     const std::vector<std::string>& words,
                                     Diagnostics& diagnostics) {
  const auto word = read_text(node, what, diagnostics);
  if (!word) return std::nullopt;
  const auto found = std::ranges::find(words, *word);
  if (found != words.end()) return found - words.begin();
  diagnostics.add(node, fmt::format("found '{}'; expected {}: {}{}", *word, what, one_of(words),
                                    did_you_mean(*word, words)));
  return std::nullopt;
}

bool is_address(const std::string& host) {
  in6_addr bytes;
  return inet_pton(AF_INET, host.c_str(), &bytes) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &bytes) == 1;
}

class PlcReader {
 public:
  PlcReader(const std::filesystem::path& directory, const Scene& scene, Diagnostics& diagnostics)
      : directory_(directory),
        scene_(scene),
        diagnostics_(diagnostics),
        names_are_known_(diagnostics.empty()) {}

  void read(const YamlNode& node, PlcSettings& settings);

 private:
  void read_period(const YamlNode& node, PlcSettings& settings);
  void read_modbus(const YamlNode& node, ModbusSettings& modbus);
  void read_mqtt(const YamlNode& node, MqttSettings& mqtt);
  std::filesystem::path read_path(MapReader& map, const char* key);
  void read_port(MapReader& map, std::uint16_t& port);
  void read_rows(const YamlNode& node, std::vector<PlcRow>& rows);
  std::optional<PlcRow> read_row(const YamlNode& node);
  void read_number_format(MapReader& map, PlcRow& row);
  void read_scope(MapReader& map, PlcRow& row);
  void refuse_missing_figures(const YamlNode& node, const PlcRow& row);

  const std::filesystem::path& directory_;
  const Scene& scene_;
  Diagnostics& diagnostics_;
  const bool names_are_known_;
};

// A report has to come in each period although ticks are not evenly spaced.
void PlcReader::read_period(const YamlNode& node, PlcSettings& settings) {
  const Range range{.least = kLeastTicks * 1e3 / scene_.rate_hz, .most = kMostPeriod_ms};
  const auto period_ms = read_number(
      node, range, fmt::format("a period in ms, of at least two ticks at {} Hz", scene_.rate_hz),
      diagnostics_);
  if (period_ms) settings.period_ns = std::llround(*period_ms * 1e6);
}

void PlcReader::read_port(MapReader& map, std::uint16_t& port) {
  const YamlNode* node = map.optional("port");
  if (node == nullptr) return;
  if (const auto number = read_integer(*node, 1, kMostPort, "a port", diagnostics_))
    port = static_cast<std::uint16_t>(*number);
}

void PlcReader::read_modbus(const YamlNode& node, ModbusSettings& modbus) {
  MapReader map(node, "the settings of Modbus", diagnostics_);
  if (const YamlNode* host = map.optional("host")) {
    modbus.host = read_text(*host, "an address of this machine", diagnostics_).value_or("");
    if (!is_address(modbus.host))
      diagnostics_.add(*host, fmt::format("found {}; expected an address of this machine, as "
                                          "192.168.0.5, or 0.0.0.0 for all of them",
                                          describe(*host)));
  }
  read_port(map, modbus.port);
  map.refuse_unknown_keys();
}

std::filesystem::path PlcReader::read_path(MapReader& map, const char* key) {
  const YamlNode* node = map.optional(key);
  if (node == nullptr) return {};
  const auto path = read_text(*node, "the path of a file", diagnostics_);
  if (path && path->empty())
    diagnostics_.add(*node, "found an empty path; expected that of a file");
  if (!path || path->empty()) return {};
  return std::filesystem::absolute(directory_ / *path).lexically_normal();
}

void PlcReader::read_mqtt(const YamlNode& node, MqttSettings& mqtt) {
  MapReader map(node, "the settings of MQTT", diagnostics_);
  if (const YamlNode* host = map.required("host")) {
    mqtt.host = read_text(*host, "the name or address of a broker", diagnostics_).value_or("");
    if (mqtt.host.empty())
      diagnostics_.add(*host, "found no name; expected the name or address of a broker");
  }
  read_port(map, mqtt.port);
  if (const YamlNode* topic = map.optional("topic")) {
    mqtt.topic = read_text(*topic, "what topics begin with", diagnostics_).value_or("");
    if (mqtt.topic.empty() || mqtt.topic.find_first_of("+#$") != std::string::npos ||
        mqtt.topic.ends_with('/'))
      diagnostics_.add(*topic, fmt::format("found {}; expected what topics begin with, as "
                                           "hall/cell1, without '+', '#' and '$'",
                                           describe(*topic)));
  }
  const YamlNode* user = map.optional("user");
  if (user != nullptr) mqtt.user = read_text(*user, "a user", diagnostics_).value_or("");
  mqtt.password_file = read_path(map, "password_file");
  mqtt.ca_file = read_path(map, "ca_file");
  mqtt.certificate_file = read_path(map, "certificate_file");
  mqtt.key_file = read_path(map, "key_file");
  if (!mqtt.password_file.empty() && user == nullptr)
    diagnostics_.add(node, "found a password_file without 'user'; expected both");
  if (mqtt.certificate_file.empty() != mqtt.key_file.empty())
    diagnostics_.add(node, "found one of certificate_file and key_file; expected both or none");
  if (mqtt.ca_file.empty() && !mqtt.certificate_file.empty())
    diagnostics_.add(node,
                     "found a certificate_file without 'ca_file'; expected the file of the "
                     "authority that the broker's certificate is of");
  map.refuse_unknown_keys();
}

// Counts and flags are one plain register, so that 0 means the same of each.
void PlcReader::read_number_format(MapReader& map, PlcRow& row) {
  const YamlNode* type = map.optional("type");
  const YamlNode* unit = map.optional("unit");
  const YamlNode* scale = map.optional("scale");
  if (!row.has_unit()) {
    for (const YamlNode* stated : {type, unit, scale}) {
      if (stated != nullptr)
        diagnostics_.add(*stated, fmt::format("found the format of '{}'; expected none: it is a "
                                              "uint16 without a unit",
                                              row.key().key));
    }
    return;
  }
  if (type != nullptr)
    row.type = static_cast<std::uint8_t>(
        read_word(*type, "the type of a register", keys_of(kPlcTypes), diagnostics_).value_or(0));
  const auto is_of_row = [&](const PlcUnit& each) { return each.quantity == row.key().quantity; };
  const auto first = std::ranges::find_if(kPlcUnits, is_of_row);
  row.unit = static_cast<std::uint8_t>(first - kPlcUnits.begin());
  if (unit != nullptr) {
    std::vector<std::string> names;
    for (auto each = first; each != kPlcUnits.end() && is_of_row(*each); ++each)
      names.emplace_back(each->key);
    row.unit +=
        static_cast<std::uint8_t>(read_word(*unit, "a unit", names, diagnostics_).value_or(0));
  }
  row.scale = row.width().is_float ? 1.0 : kPlcUnits[row.unit].standard;
  if (scale != nullptr) {
    constexpr Range kScales{.least = 1e-9, .most = 1e9};
    row.scale = read_number(*scale, kScales, "units for one count of the register", diagnostics_)
                    .value_or(row.scale);
  }
}

void PlcReader::read_scope(MapReader& map, PlcRow& row) {
  std::vector<std::string> zones, robots;
  for (const Zone& zone : scene_.zones) zones.push_back(zone.name);
  for (const Robot& robot : scene_.robots) {
    if (!robot.is_attached) robots.push_back(robot.name);
  }
  const auto read = [&](const char* key, bool is_allowed, const std::vector<std::string>& names,
                        std::string& name) {
    const YamlNode* node = map.optional(key);
    if (node == nullptr) return;
    name = read_text(*node, fmt::format("the name of a {}", key), diagnostics_).value_or("");
    if (!is_allowed) {
      diagnostics_.add(*node, fmt::format("found '{}' with a {}; expected none: it is no figure of "
                                          "one {}",
                                          row.key().key, key, key));
    } else if (names_are_known_ && std::ranges::find(names, name) == names.end()) {
      diagnostics_.add(*node,
                       fmt::format("found '{}'; expected a {} of the cell{}{}{}", name, key,
                                   names.empty() ? ", which has none" : ": ",
                                   names.empty() ? "" : one_of(names), did_you_mean(name, names)));
    }
  };
  read("zone", row.key().of_zone, zones, row.zone);
  read("robot", row.key().of_robot, robots, row.robot);
}

// A register that can never have another value than the safe end would look like a fault.
void PlcReader::refuse_missing_figures(const YamlNode& node, const PlcRow& row) {
  if (!names_are_known_ || !diagnostics_.empty()) return;
  if (!row.zone.empty() && !row.robot.empty()) {
    diagnostics_.add(node, "found both 'zone' and 'robot'; expected one of them");
    return;
  }
  const auto zone = std::ranges::find(scene_.zones, row.zone, &Zone::name);
  const auto robot = std::ranges::find(scene_.robots, row.robot, &Robot::name);
  std::string missing;
  if (row.value == PlcValue::kClear && scene_.zones.empty()) missing = "zones";
  if (row.value == PlcValue::kSpeedScaling || row.value == PlcValue::kStopMargin) {
    if (!row.zone.empty() && !zone->separation) missing = "'separation' of that zone";
    if (!row.robot.empty() && !robot->stopping.is_stated()) missing = "'stopping' of that robot";
    const bool is_by_zones = row.value == PlcValue::kSpeedScaling && !scene_.zones.empty();
    if (row.zone.empty() && row.robot.empty() && !separated_count(scene_).any() && !is_by_zones)
      missing = "'stopping' of a robot or 'separation' of a zone";
  }
  if (!missing.empty())
    diagnostics_.add(node, fmt::format("found '{}' in a cell without {}; expected a cell that "
                                       "states what the figure follows from",
                                       row.key().key, missing));
}

std::optional<PlcRow> PlcReader::read_row(const YamlNode& node) {
  MapReader map(node, "a row of registers", diagnostics_);
  const YamlNode* value_node = map.required("value");
  const YamlNode* at_node = map.required("at");
  if (value_node == nullptr || at_node == nullptr) return std::nullopt;
  const auto value = read_word(*value_node, "a value", keys_of(kPlcValues), diagnostics_);
  const auto at =
      read_integer(*at_node, 0, kMostAddress, "the address of a register", diagnostics_);
  if (!value || !at) return std::nullopt;
  PlcRow row{.value = static_cast<PlcValue>(*value), .at = static_cast<std::uint16_t>(*at)};
  const std::size_t before = diagnostics_.count();
  read_number_format(map, row);
  read_scope(map, row);
  map.refuse_unknown_keys();
  if (row.at + row.width().registers > kMostAddress + 1)
    diagnostics_.add(*at_node, fmt::format("found {}; expected an address whose last register is "
                                           "at most {}",
                                           *at, kMostAddress));
  if (diagnostics_.count() != before) return std::nullopt;
  refuse_missing_figures(node, row);
  return row;
}

void PlcReader::read_rows(const YamlNode& node, std::vector<PlcRow>& rows) {
  rows.clear();
  const std::size_t before = diagnostics_.count();
  for (const YamlNode& item : read_list(node, "rows of registers", diagnostics_)) {
    const auto row = read_row(item);
    if (!row) continue;
    for (const PlcRow& other : rows) {
      if (row->at < other.at + other.width().registers &&
          other.at < row->at + row->width().registers)
        diagnostics_.add(item, fmt::format("found '{}' at {} and '{}' at {}; expected registers of "
                                           "its own for each",
                                           row->key().key, row->at, other.key().key, other.at));
      if (row->value == other.value && row->zone == other.zone && row->robot == other.robot)
        diagnostics_.add(
            item, fmt::format("found '{}' twice; expected each figure once", row->key().key));
    }
    rows.push_back(*row);
  }
  std::ranges::sort(rows, {}, &PlcRow::at);
  if (diagnostics_.count() == before &&
      std::ranges::find(rows, PlcValue::kHeartbeat, &PlcRow::value) == rows.end())
    diagnostics_.add(node,
                     "found no row with 'value: heartbeat'; expected one: without it a "
                     "controller cannot tell that figures are old");
}

void PlcReader::read(const YamlNode& node, PlcSettings& settings) {
  MapReader map(node, "the settings of PLCs", diagnostics_);
  if (const YamlNode* period = map.optional("period_ms")) read_period(*period, settings);
  if (const YamlNode* order = map.optional("order"))
    settings.order = static_cast<std::uint8_t>(
        read_word(*order, "an order of bytes", keys_of(kPlcOrders), diagnostics_).value_or(0));
  if (const YamlNode* modbus = map.optional("modbus")) read_modbus(*modbus, settings.modbus);
  if (const YamlNode* mqtt = map.optional("mqtt")) read_mqtt(*mqtt, settings.mqtt);
  if (const YamlNode* rows = map.optional("registers")) read_rows(*rows, settings.rows);
  map.refuse_unknown_keys();
}

}  // namespace

PlcSettings read_plc(MapReader& cell, const std::filesystem::path& directory, const Scene& scene,
                     Diagnostics& diagnostics) {
  PlcSettings settings = default_plc(scene);
  if (const YamlNode* node = cell.optional("plc"))
    PlcReader(directory, scene, diagnostics).read(*node, settings);
  return settings;
}

}  // namespace clearance
