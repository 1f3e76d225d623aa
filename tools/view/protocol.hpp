// The part of Foxglove's WebSocket protocol, version 1, that this server supports:
// https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
//
// JSON texts: serverInfo, advertise, status, parameterValues; subscribe, unsubscribe,
// getParameters, setParameters, subscribeParameterUpdates. Binary: message data and time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/view/channels.hpp"

namespace clearance::view {

// In the order of preference; this server treats both alike.
inline constexpr std::array<std::string_view, 2> kSubprotocols = {"foxglove.websocket.v1",
                                                                  "foxglove.sdk.v1"};

[[nodiscard]] std::string server_info(std::string_view name, std::string_view session);
[[nodiscard]] std::string advertise(std::span<const Channel> channels);
// `level` 0 to 2: information, warning, error. An empty text withdraws the status `id`.
[[nodiscard]] std::string status(std::string_view id, int level, std::string_view text);
[[nodiscard]] std::string parameter_values(const nlohmann::json& values, const std::string& id);

inline constexpr std::size_t kMessageHeader = 13, kTimeMessage = 9;
[[nodiscard]] std::array<std::byte, kMessageHeader> message_header(std::uint32_t subscription,
                                                                   std::int64_t time_ns);
[[nodiscard]] std::array<std::byte, kTimeMessage> time_message(std::int64_t time_ns);

// A client's request; an unknown one is kIgnored.
struct Request {
  enum class Kind {
    kIgnored,
    kSubscribe,
    kUnsubscribe,
    kGetParameters,
    kSetParameters,
    kSubscribeParameters
  };
  struct Subscription {
    std::uint32_t id;
    ChannelId channel;
  };
  Kind kind = Kind::kIgnored;
  std::vector<Subscription> subscriptions = {};  // kSubscribe
  std::vector<std::uint32_t> ids = {};           // kUnsubscribe
  nlohmann::json parameters = {};                // kSetParameters: an array of {name, value}
  std::string id = {};                           // returned with the parameters
};
[[nodiscard]] Request parse_request(std::string_view text);

}  // namespace clearance::view
