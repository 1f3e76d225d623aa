// What a cell says about controllers: `plc:`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/cells.hpp"
#include "tests/shared/mistake_at.hpp"

namespace clearance {
namespace {

using test::mistake_at;
using testing::ElementsAre;
using testing::IsEmpty;

const std::string kZones =
    "zones:\n"
    "  - {name: near, between: [arm, still], enter_below: 1, leave_above: 2}\n"
    "  - name: people\n"
    "    between: [left, floor]\n"
    "    enter_below: 1\n"
    "    leave_above: 2\n"
    "    separation: {human: left, reaction_time_ms: 1, stopping_time_ms: 1, stopping_distance: "
    "1,\n"
    "                 intrusion_distance: 0.1}\n";
const std::string kBeat = "{value: heartbeat, at: 0}";

std::string with_plc(const std::string& plc) {
  return cell_text("plc: {" + plc + "}\n" + kBoxes + kZones);
}
std::string with_rows(const std::string& rows) {
  return with_plc("registers: [" + kBeat + ", " + rows + "]");
}
std::vector<int> addresses(const PlcSettings& plc) {
  std::vector<int> all;
  for (const PlcRow& row : plc.rows) all.push_back(row.at);
  return all;
}

TEST(PlcOfACell, HasRowsForAllThatTheCellHas) {
  const PlcSettings bare = read_good(cell_text(kBoxes)).plc;
  EXPECT_THAT(addresses(bare), ElementsAre(0, 1, 2, 3, 4, 5, 11));
  const PlcSettings zones = read_good(cell_text(kBoxes + kZones)).plc;
  EXPECT_THAT(addresses(zones), ElementsAre(0, 1, 2, 3, 4, 5, 10, 11, 12, 13, 100, 101, 402, 403));
  EXPECT_EQ(zones.rows[11].zone, "people");
  EXPECT_EQ(zones.rows[7].per_si(), 1000.0);
  EXPECT_EQ(zones.rows[8].per_si(), 1000.0);
  EXPECT_EQ(zones.period_ns, 10'000'000);
  EXPECT_THAT(zones.mqtt.host, IsEmpty());
}

// A report has to come in each period.
TEST(PlcOfACell, HasAPeriodOfSeveralTicks) {
  std::string slow = cell_text(kBoxes);
  slow.replace(slow.find("500"), 3, "20");
  EXPECT_EQ(read_good(slow).plc.period_ns, 150'000'000);
  EXPECT_EQ(read_good(with_plc("period_ms: 4")).plc.period_ns, 4'000'000);
  EXPECT_THAT(errors_of(with_plc("period_ms: 3.9")), mistake_at("cell.yaml:4:18", "3.9"));
  EXPECT_THAT(errors_of(with_plc("period_ms: 1001")), mistake_at("cell.yaml:4:18", "1001"));
}

TEST(PlcOfACell, MapsFiguresToRegisters) {
  const PlcSettings plc =
      read_good(with_rows("{value: stop_margin, zone: people, at: 9, type: int32, unit: m, scale: "
                          "0.002}, {value: least_distance, at: 5, type: float32}"))
          .plc;
  ASSERT_EQ(plc.rows.size(), 3u);
  EXPECT_THAT(addresses(plc), ElementsAre(0, 5, 9));
  EXPECT_EQ(plc.rows[1].width().key, "float32");
  EXPECT_EQ(plc.rows[1].per_si(), 1000.0);  // millimetres, one by one
  EXPECT_EQ(plc.rows[2].value, PlcValue::kStopMargin);
  EXPECT_EQ(plc.rows[2].zone, "people");
  EXPECT_EQ(plc.rows[2].width().registers, 2);
  EXPECT_EQ(plc.rows[2].per_si(), 500.0);
}

TEST(PlcOfACell, RefusesRowsThatMeanNothing) {
  const auto expect = [](const std::string& rows, const auto&... words) {
    EXPECT_THAT(errors_of(with_rows(rows)), mistake_at("cell.yaml:4", words...)) << rows;
  };
  expect("{value: speed, at: 3}", "'speed'");
  expect("{value: clear, at: 65536}", "65536");
  expect("{value: clear, at: 3, type: int8}", "'clear'");
  expect("{value: least_distance, at: 3, type: int8}", "'int8'");
  expect("{value: least_distance, at: 65535, type: int32}", "65535");
  expect("{value: least_distance, at: 3, unit: percent}", "'percent'");
  expect("{value: least_distance, at: 3, scale: 0}", "0");
  expect("{value: least_distance, at: 3, zone: people}", "'least_distance'");
  expect("{value: clear, at: 3, zone: nowhere}", "'nowhere'");
  expect("{value: clear, at: 3, robot: people}", "'clear'");
  expect("{value: speed_scaling, at: 3, robot: left}", "'left'");
  expect("{value: stop_margin, at: 3, zone: near}", "'stop_margin'");
  expect("{value: clear, at: 0}", "'clear'", "'heartbeat'");
  expect("{value: least_distance, at: 3, type: int32}, {value: clear, at: 4}", "'clear'");
  expect("{value: clear, at: 3}, {value: clear, at: 4}", "'clear'");
  expect("{value: clear, at: 3, order: ABCD}", "'order'");
  EXPECT_THAT(errors_of(with_plc("registers: [{value: clear, at: 0}]")),
              mistake_at("cell.yaml:4:18", "heartbeat"));
  EXPECT_THAT(
      errors_of(cell_text("plc: {registers: [" + kBeat + ", {value: clear, at: 1}]}\n" + kBoxes)),
      mistake_at("cell.yaml:4", "'clear'", "zones"));
}

TEST(PlcOfACell, SaysWhereItIsServed) {
  const PlcSettings plc =
      read_good(with_plc("order: CDAB, modbus: {host: '::', port: 502}, mqtt: {host: broker, port: "
                         "8883, topic: hall/one, user: plc, password_file: secret, ca_file: "
                         "/etc/ca.pem, certificate_file: own.pem, key_file: own.key}"))
          .plc;
  EXPECT_EQ(kPlcOrders[plc.order], "CDAB");
  EXPECT_EQ(plc.modbus.host, "::");
  EXPECT_EQ(plc.modbus.port, 502);
  EXPECT_EQ(plc.mqtt.topic, "hall/one");
  EXPECT_EQ(plc.mqtt.password_file, std::filesystem::absolute("secret"));
  EXPECT_EQ(plc.mqtt.ca_file, "/etc/ca.pem");
  const auto expect = [](const std::string& text, const auto&... words) {
    EXPECT_THAT(errors_of(with_plc(text)), mistake_at("cell.yaml:4", words...)) << text;
  };
  expect("order: ABDC", "'ABDC'");
  expect("modbus: {host: localhost}", "'localhost'");
  expect("modbus: {port: 0}", "0");
  expect("modbus: {ports: 1}", "'ports'");
  expect("mqtt: {port: 1}", "host");
  expect("mqtt: {host: b, topic: a/#}", "'a/#'");
  expect("mqtt: {host: b, password_file: f}", "password_file");
  expect("mqtt: {host: b, password: secret}", "'password'");
  expect("mqtt: {host: b, ca_file: a, key_file: b}", "key_file");
  expect("mqtt: {host: b, key_file: b, certificate_file: c}", "ca_file");
  expect("register: []", "'register'");
}

}  // namespace
}  // namespace clearance
