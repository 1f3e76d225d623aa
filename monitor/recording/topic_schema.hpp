// The topics as a recording holds them: schema name and text, message encoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "monitor/files/format.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

// Well-known encodings of the MCAP registry (mcap.dev/spec/registry).
inline constexpr std::string_view kCdrEncoding = "cdr";
inline constexpr std::string_view kIdlEncoding = "omgidl";

// The topic whose type has this schema name, if any.
[[nodiscard]] std::optional<TopicKind> topic_kind(std::string_view type_name) noexcept;

// The name of the topic's type without modules: "Distances".
[[nodiscard]] std::string_view type_of(TopicKind kind) noexcept;

// Name, encoding and self-contained IDL text of the topic's type.
[[nodiscard]] const McapSchema& topic_schema(TopicKind kind);

// A recording holds more than the topics of a cell: frames of sensors (SensorFrame), and the
// states of partners that the daemon took over (PartnerState). Each has a channel of its own.
enum class SideTopic : std::uint8_t { kFrames, kStates };
inline constexpr std::size_t kSideTopics = 2;
[[nodiscard]] const char* name(SideTopic topic) noexcept;  // "clearance/frames"
[[nodiscard]] const McapSchema& side_schema(SideTopic topic);

// The files of idl/ as they were when this was built.
extern const char* const kIdlText;
extern const char* const kFramesIdlText;
extern const char* const kPartnersIdlText;

// The part of `idl` that `type` (e.g. PoseBatch) needs. The text is written as clearance.idl is:
// constants of one line and structs, inside modules, each used after its definition. Comments are
// left out. Empty when there is no such struct.
[[nodiscard]] std::string self_contained_idl(std::string_view idl, std::string_view type);

}  // namespace clearance
