// Between our structs and the DDS types. What runs beside the tick allocates nothing: its sequences
// are sized once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "config/scene.hpp"
#include "monitor/input.hpp"
#include "monitor/report.hpp"
#include "monitor/wire/sample.hpp"

namespace clearance {

inline constexpr std::size_t kSourceNameLength = 32;  // idl/clearance.idl: string<32>

// The last batch of a source that a tick used.
struct SourceUse {
  std::array<char, kSourceNameLength + 1> source{};  // NUL-terminated
  std::uint64_t sequence_number = 0;
};

// A sample for every report of this scene: room for its published pairs and for kMaxSources
// sources.
[[nodiscard]] Sample<clearance_msg_Distances> make_distances(const Scene& scene);

// Fills `out`, made by make_distances for the same scene; `publish_ns` 0 when it is not published.
// Pairs or sources beyond the room are left out and false is returned: with a fitting sample it
// never happens.
bool to_wire(const Report& report, std::span<const SourceUse> sources, std::int64_t publish_ns,
             clearance_msg_Distances& out) noexcept;

// One pair as it stands in Distances.
void to_wire(const PairReport& pair, clearance_msg_PairDistance& out) noexcept;

// State of zone `zone` (an index into Scene::zones and Report::zones). Zone names longer than 64
// bytes are cut; the id is what identifies a zone.
void to_wire(const Scene& scene, const Report& report, std::uint32_t zone,
             clearance_msg_ZoneState& out) noexcept;

// Allocates. Names, pairs, zones and the text of the cell.
[[nodiscard]] Sample<clearance_msg_Catalogue> make_catalogue(const Scene& scene);

struct BatchRead {
  std::size_t samples = 0;  // written to the front of `out`
  std::size_t dropped = 0;  // did not fit
  bool wrong_revision =
      false;  // made for another scene: no sample written, all are Reject::kWrongRevision
};

// The poses of a batch as the tick takes them, in their order and unchecked: the tick refuses
// unknown ids, non-finite numbers and the rest. `scene_revision` of the scene in use; a batch of
// revision 0 is not checked against it.
[[nodiscard]] BatchRead from_wire(const clearance_msg_PoseBatch& batch,
                                  std::uint64_t scene_revision, std::span<PoseSample> out) noexcept;

// A batch with room for `poses` poses, for writing.
[[nodiscard]] Sample<clearance_msg_PoseBatch> make_batch(std::string_view source,
                                                         std::size_t poses);

// Replaces the poses of `batch`, made by make_batch. False: more samples than it has room for; the
// first ones are in. Source, sequence number and revision are left alone.
bool to_wire(std::span<const PoseSample> samples, clearance_msg_PoseBatch& batch) noexcept;

}  // namespace clearance
