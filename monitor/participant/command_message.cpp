// Both directions go by the lists of change_fields.hpp.
#include "monitor/participant/command_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "monitor/participant/change_fields.hpp"
#include "monitor/participant/wire_values.hpp"

namespace clearance {
namespace {

std::size_t longest(ChangeText kind) {
  switch (kind) {
    case ChangeText::kName:
      return kLongestName;
    case ChangeText::kMayBeEmpty:
      return kLongestReason;
    case ChangeText::kYaml:
      break;
  }
  return kLongestYaml;
}

// Fills a change from a message until it meets a value that is none.
class FromWire {
 public:
  // `path` is that of the change: "changes[0].attach".
  FromWire(std::string path, std::optional<MalformedField>& fault)
      : path_(std::move(path)), fault_(fault) {}

  template <class From, class To, class... Kind>
  void operator()(std::string_view name, const From& from, To& to, Kind... kind) const {
    if (!fault_) take(fmt::format("{}.{}", path_, name), from, to, kind...);
  }

 private:
  void refuse(const std::string& path, std::string reason) const {
    if (!fault_) fault_ = MalformedField{0, path, std::move(reason)};
  }
  void take(const std::string& path, const char* from, std::string& to, ChangeText kind) const {
    const std::string_view text = text_of(from);
    auto fault = fault_of_text(text, longest(kind), kind == ChangeText::kMayBeEmpty);
    if (fault) return refuse(path, *std::move(fault));
    to = text;
  }
  void take(const std::string& path, const dds_sequence_string& from, std::vector<std::string>& to,
            ChangeText kind) const {
    if (from._length > clearance_msg_kMaxObjects)
      return refuse(path, fmt::format("found {} names; expected at most {}", from._length,
                                      clearance_msg_kMaxObjects));
    for (std::uint32_t i = 0; i < from._length; ++i)
      take(fmt::format("{}[{}]", path, i), from._buffer[i], to.emplace_back(), kind);
  }
  void take(const std::string& path, const dds_sequence_clearance_msg_JointPosition& from,
            std::vector<JointPosition>& to) const {
    if (from._length > clearance_msg_kMaxJoints)
      return refuse(path, fmt::format("found {} joints; expected at most {}", from._length,
                                      clearance_msg_kMaxJoints));
    for (std::uint32_t i = 0; i < from._length; ++i) {
      JointPosition& joint = to.emplace_back();
      take(fmt::format("{}[{}].joint", path, i), from._buffer[i].joint, joint.joint,
           ChangeText::kName);
      take(fmt::format("{}[{}].position", path, i), from._buffer[i].position, joint.position);
    }
  }
  void take(const std::string&, bool from, bool& to) const { to = from; }
  void take(const std::string& path, double from, double& to) const {
    if (!std::isfinite(from)) return refuse(path, not_finite(from));
    to = from;
  }
  void take(const std::string& path, std::uint8_t from, SetPair::Rule& to) const {
    constexpr auto kLast = static_cast<std::uint8_t>(SetPair::Rule::kNoException);
    if (from > kLast)
      return refuse(path, fmt::format("found the rule {}; expected 0 to {}", from, kLast));
    to = static_cast<SetPair::Rule>(from);
  }
  void take(const std::string& path, const clearance_msg_Placement& from, Pose& to) const {
    if (auto fault = take_placement(from, to))
      refuse(fmt::format("{}.{}", path, fault->field), std::move(fault->reason));
  }
  void take(const std::string&, std::int64_t from, std::int64_t& to) const { to = from; }
  // The ends of a contact: those that are not stated stay.
  void take(const std::string& path, const clearance_msg_StatedNumber& from, double& to) const {
    if (from.is_stated) take(path, from.value, to);
  }
  void take(const std::string&, const clearance_msg_StatedTime& from, std::int64_t& to) const {
    if (from.is_stated) to = from.value;
  }
  void take(const std::string& path, const clearance_msg_StatedTime& from,
            std::uint64_t& to) const {
    if (!from.is_stated) return;
    if (from.value < 0)
      return refuse(path, fmt::format("found {}; expected a cycle from 0 on", from.value));
    to = static_cast<std::uint64_t>(from.value);
  }
  template <class From, class To, class... Kind>
  void take(const std::string& path, const From& from, std::optional<To>& to, Kind... kind) const {
    if (from.is_stated) take(path, from.value, to.emplace(), kind...);
  }

  std::string path_;
  std::optional<MalformedField>& fault_;
};

// Fills a message from a change. Everything in it is allocated by Cyclone.
struct ToWire {
  template <class To, class From, class... Kind>
  void operator()(std::string_view, To& to, const From& from, Kind...) const {
    put(from, to);
  }

 private:
  static void put(const std::string& from, char*& to) { put_value(from, to); }
  static void put(const std::vector<std::string>& from, dds_sequence_string& to) {
    put_value(from, to);
  }
  static void put(const std::vector<JointPosition>& from,
                  dds_sequence_clearance_msg_JointPosition& to) {
    put_list(from, to, [](const JointPosition& joint, clearance_msg_JointPosition& out) {
      put(joint.joint, out.joint);
      out.position = joint.position;
    });
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  static void put(Number from, Number& to) { to = from; }
  static void put(SetPair::Rule from, std::uint8_t& to) { to = static_cast<std::uint8_t>(from); }
  static void put(const Pose& from, clearance_msg_Placement& to) { put_value(from, to); }
  static void put(double from, clearance_msg_StatedNumber& to) {
    to = {.is_stated = from != ContactEnd{}.distance, .value = from};
  }
  static void put(std::int64_t from, clearance_msg_StatedTime& to) {
    to = {.is_stated = from != ContactEnd::kNoTime, .value = from};
  }
  static void put(std::uint64_t from, clearance_msg_StatedTime& to) {
    to = {.is_stated = from != ContactEnd::kNoCycle, .value = static_cast<std::int64_t>(from)};
  }
  template <class From, class To>
  static void put(const std::optional<From>& from, To& to) {
    to.is_stated = from.has_value();
    if (from) put(*from, to.value);
  }
};

std::optional<MalformedField> take_change(const clearance_msg_Change& message, std::size_t place,
                                          CellChange& change) {
  std::optional<MalformedField> fault;
  bool is_known = false;
  // A message may carry a number that the enumeration does not have, so it is compared as a number.
  std::uint32_t kind = 0;
  static_assert(sizeof kind == sizeof message._d);
  std::memcpy(&kind, &message._d, sizeof kind);
  for_each_change_kind([&](const auto& row) {
    if (kind != static_cast<std::uint32_t>(row.kind)) return;
    using Change = typename std::remove_cvref_t<decltype(row)>::Type;
    is_known = true;
    visit_fields<Change>(FromWire(fmt::format("changes[{}].{}", place, row.name), fault),
                         message._u.*row.member, change.emplace<Change>());
  });
  if (!is_known) {
    fault = MalformedField{0, fmt::format("changes[{}]", place),
                           fmt::format("found the kind {}; expected 0 to {}", kind,
                                       std::variant_size_v<CellChange> - 1)};
  }
  if (fault) fault->change = static_cast<std::uint32_t>(place);
  return fault;
}

// A plain name becomes that of a file below a folder of the daemon.
bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '-' || c == '.';
         });
}

std::optional<MalformedField> take_files(const clearance_msg_Command& message,
                                         std::vector<SentFile>& files) {
  std::size_t bytes = 0;
  for (std::uint32_t i = 0; i < message.files._length; ++i) {
    const clearance_msg_SentFile& file = message.files._buffer[i];
    const std::string path = fmt::format("files[{}]", i);
    const std::string name(text_of(file.name));
    if (!is_plain_name(name)) {
      return MalformedField{0, path + ".name",
                            fmt::format("found a name that is no plain one; expected letters, "
                                        "digits, '_', '-' and '.', at most {} bytes",
                                        kLongestName)};
    }
    if (std::ranges::find(files, name, &SentFile::name) != files.end())
      return MalformedField{0, path + ".name",
                            fmt::format("found '{}' twice; expected different names", name)};
    bytes += file.bytes._length;
    if (bytes > kLargestFiles) {
      return MalformedField{0, path + ".bytes",
                            fmt::format("found files of more than {} bytes together; expected "
                                        "fewer",
                                        kLargestFiles)};
    }
    files.push_back({name, {}});
    if (file.bytes._length > 0) {
      files.back().bytes.assign(reinterpret_cast<const char*>(file.bytes._buffer),
                                file.bytes._length);
    }
  }
  return std::nullopt;
}

}  // namespace

std::variant<Command, MalformedField> from_wire(const clearance_msg_Command& message) {
  Command command{.client = message.client,
                  .request = message.request,
                  .scene_revision = message.scene_revision,
                  .dry_run = message.dry_run};
  if (command.client.empty() || end_of_utf8(command.client) != command.client.size())
    return MalformedField{0, "client", "found no name in UTF-8; expected one of 1 to 32 bytes"};
  if (command.request == 0)
    return MalformedField{0, "request", "found 0; expected a number from 1 that counts up"};
  for (std::uint32_t i = 0; i < message.changes._length; ++i) {
    if (auto fault =
            take_change(message.changes._buffer[i], i, command.changes.emplace_back(AddObject{}))) {
      return *std::move(fault);
    }
  }
  if (auto fault = take_files(message, command.files)) return *std::move(fault);
  return command;
}

Sample<clearance_msg_Command> to_wire(const Command& command) {
  Sample<clearance_msg_Command> message;
  copy_text(command.client, message->client);
  message->request = command.request;
  message->scene_revision = command.scene_revision;
  message->dry_run = command.dry_run;
  reserve_sequence(message->changes, command.changes.size());
  for (const CellChange& change : command.changes) {
    clearance_msg_Change& out = message->changes._buffer[message->changes._length++];
    for_each_change_kind([&](const auto& row) {
      using Change = typename std::remove_cvref_t<decltype(row)>::Type;
      const auto* of = std::get_if<Change>(&change);
      if (of == nullptr) return;
      out._d = row.kind;
      visit_fields<Change>(ToWire{}, out._u.*row.member, *of);
    });
  }
  reserve_sequence(message->files, command.files.size());
  for (const SentFile& file : command.files) {
    clearance_msg_SentFile& out = message->files._buffer[message->files._length++];
    out.name = dds_string_dup(file.name.c_str());
    reserve_sequence(out.bytes, file.bytes.size());
    for (const char byte : file.bytes)
      out.bytes._buffer[out.bytes._length++] = static_cast<std::uint8_t>(byte);
  }
  return message;
}

CommandResult from_wire(const clearance_msg_CommandResult& message) {
  return {.client = message.client,
          .request = message.request,
          .status = static_cast<CommandStatus>(message.status),
          .change = message.change,
          .path = std::string(text_of(message.path)),
          .reason = std::string(text_of(message.reason)),
          .scene_revision = message.scene_revision,
          .in_force_from = message.in_force_from};
}

Sample<clearance_msg_CommandResult> to_wire(const CommandResult& result, std::uint64_t daemon) {
  Sample<clearance_msg_CommandResult> message;
  copy_text(result.client, message->client);
  message->request = result.request;
  message->daemon = daemon;
  message->status = static_cast<std::uint8_t>(result.status);
  message->change = result.change;
  message->path = dds_string_dup(result.path.c_str());
  message->reason = dds_string_dup(result.reason.c_str());
  message->scene_revision = result.scene_revision;
  message->in_force_from = result.in_force_from;
  return message;
}

}  // namespace clearance
