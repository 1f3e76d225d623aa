// The topics as a recording holds them: schema name and text, message encoding.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "monitor/mcap/format.hpp"
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

// The same of frames of sensors, which recordings alone have, on the topic kFramesTopic.
[[nodiscard]] const McapSchema& frames_schema();
inline constexpr const char* kFramesTopic = "clearance/frames";

// idl/clearance.idl and idl/frames.idl as they were when this was built.
extern const char* const kIdlText;
extern const char* const kFramesIdlText;

// The part of `idl` that `type` (e.g. PoseBatch) needs. The text is written as clearance.idl is:
// constants of one line and structs, inside modules, each used after its definition. Comments are
// left out. Empty when there is no such struct.
[[nodiscard]] std::string self_contained_idl(std::string_view idl, std::string_view type);

}  // namespace clearance
