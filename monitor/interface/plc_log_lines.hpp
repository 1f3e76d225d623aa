// The log lines of clearance-plc; log_lines.hpp has those of the daemon, and the rules for both.
#pragma once

#include "monitor/interface/log_lines.hpp"

namespace clearance::lines {

inline constexpr LogLine<Text, Text, Text, double> kPlcStarted{
    "plc-started", kInfo,
    "cell '{}' on {}; registers at {} by Modbus TCP, fail-safe after {:g} ms without a good "
    "report"};
inline constexpr LogLine<> kPlcGood{"plc-good", kInfo, "the figures are good"};
inline constexpr LogLine<Text> kPlcFailSafe{"plc-fail-safe", kWarn,
                                            "all figures are fail-safe: {}"};
inline constexpr LogLine<Text, Text> kPlcMisfit{
    "plc-misfit", kWarn,
    "the figure '{}' is above what {} holds, and is fail-safe while it is: state another type, "
    "unit or scale"};
inline constexpr LogLine<Text, int, Count> kPlcWriteRefused{
    "plc-write-refused", kWarn,
    "a write of {} (function {}) is refused, since registers are read-only ({} refused so far)"};
inline constexpr LogLine<Text, Text, Count> kPlcClientDropped{
    "plc-client-dropped", kWarn, "the client {} is dropped: {} ({} dropped so far)"};
inline constexpr LogLine<Text> kMqttConnected{"mqtt-connected", kInfo,
                                              "the MQTT broker {} takes the figures"};
inline constexpr LogLine<Text, Text> kMqttAway{"mqtt-away", kWarn,
                                               "the MQTT broker {} does not take the figures: {}"};

}  // namespace clearance::lines
