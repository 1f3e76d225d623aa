// Commands and results as messages of idl/commands.idl, in both directions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include "monitor/interface/command.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The largest texts and files of a message, bytes. Longer ones are refused.
inline constexpr std::size_t kLongestName = 64;  // as in a cell (read_name)
inline constexpr std::size_t kLongestReason = 1000;
inline constexpr std::size_t kLongestYaml = 16 << 20;
inline constexpr std::size_t kLargestFiles = 64 << 20;  // all files of a command together

// Why a message is no command: the field and a sentence about its value.
struct MalformedField {
  std::uint32_t change = 0;  // its index; 0 for fields of the command itself
  std::string path;          // "changes[0].attach.to"
  std::string reason;
};

// Reads a message. Its client must be readable as text in any case. Refused are kinds and rules
// that do not exist, numbers that are not finite, quaternions that are not of unit length, texts
// that are empty, too long, or no UTF-8, and names of files that are no plain names.
[[nodiscard]] std::variant<Command, MalformedField> from_wire(const clearance_msg_Command& message);

// Makes the message of a command. It allocates. The longest client has 32 bytes; more are cut off.
[[nodiscard]] Sample<clearance_msg_Command> to_wire(const Command& command);

// Results. `daemon` as in all messages of a daemon.
[[nodiscard]] CommandResult from_wire(const clearance_msg_CommandResult& message);
[[nodiscard]] Sample<clearance_msg_CommandResult> to_wire(const CommandResult& result,
                                                          std::uint64_t daemon);

}  // namespace clearance
