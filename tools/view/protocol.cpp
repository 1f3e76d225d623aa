#include "tools/view/protocol.hpp"

#include <bit>
#include <cstring>

namespace clearance::view {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the protocol is little-endian");

std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

Request subscribe_request(const json& message) {
  Request request{Request::Kind::kSubscribe};
  for (const json& entry : message.at("subscriptions")) {
    request.subscriptions.push_back({entry.at("id"), entry.at("channelId")});
  }
  return request;
}

Request request_of(const json& message) {
  const std::string operation = message.at("op");
  if (operation == "subscribe") return subscribe_request(message);
  if (operation == "unsubscribe") {
    return {Request::Kind::kUnsubscribe, {}, message.at("subscriptionIds")};
  }
  if (operation == "getParameters") {
    return {Request::Kind::kGetParameters, {}, {}, {}, message.value("id", "")};
  }
  if (operation == "setParameters") {
    return {
        Request::Kind::kSetParameters, {}, {}, message.at("parameters"), message.value("id", "")};
  }
  if (operation == "subscribeParameterUpdates") return {Request::Kind::kSubscribeParameters};
  return {};
}

}  // namespace

std::string server_info(std::string_view name, std::string_view session) {
  return dumped({{"op", "serverInfo"},
                 {"name", name},
                 {"capabilities", {"time", "parameters", "parametersSubscribe"}},
                 {"supportedEncodings", json::array()},
                 {"metadata", json::object()},
                 {"sessionId", session}});
}

std::string advertise(std::span<const Channel> channels) {
  json list = json::array();
  for (std::size_t id = 0; id < channels.size(); ++id) {
    const Channel& channel = channels[id];
    list.push_back({{"id", id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.schema.name},
                    {"schema", channel.schema.text},
                    {"schemaEncoding", channel.schema.encoding}});
  }
  return dumped({{"op", "advertise"}, {"channels", list}});
}

std::string status(std::string_view id, int level, std::string_view text) {
  if (text.empty()) return dumped({{"op", "removeStatus"}, {"statusIds", {id}}});
  return dumped({{"op", "status"}, {"id", id}, {"level", level}, {"message", text}});
}

std::string parameter_values(const json& values, const std::string& id) {
  json message = {{"op", "parameterValues"}, {"parameters", values}};
  if (!id.empty()) message["id"] = id;
  return dumped(message);
}

std::array<std::byte, kMessageHeader> message_header(std::uint32_t subscription,
                                                     std::int64_t time_ns) {
  std::array<std::byte, kMessageHeader> header{std::byte{1}};
  std::memcpy(&header[1], &subscription, sizeof subscription);
  std::memcpy(&header[5], &time_ns, sizeof time_ns);
  return header;
}

std::array<std::byte, kTimeMessage> time_message(std::int64_t time_ns) {
  std::array<std::byte, kTimeMessage> message{std::byte{2}};
  std::memcpy(&message[1], &time_ns, sizeof time_ns);
  return message;
}

Request parse_request(std::string_view text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) return {};
  try {
    return request_of(message);
  } catch (const json::exception&) {
    return {};
  }
}

}  // namespace clearance::view
