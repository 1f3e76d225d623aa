// Names what a change of the cell changes for a person: objects and tools, what carries them, and
// the contacts that are allowed.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance::view {

// When a scene came into force. `is_first`: scenes before it are not known.
struct SceneBegin {
  std::uint64_t cycle = 0;
  double seconds = 0.0;  // after the first report of a recording; live 0
  bool is_first = false;
};

// An object that moves with its carrier: a link, or another object.
struct Attached {
  std::string object, carrier;
  SceneBegin since = {};  // `is_first`: it was attached then, and maybe before
};

// The attached objects of a scene, in its order. Those that `before` has with the same carrier keep
// the time from there.
[[nodiscard]] std::vector<Attached> attached_in(const Scene& scene,
                                                std::span<const Attached> before,
                                                const SceneBegin& begin);

// An array of {"object", "carrier", "cycle", "seconds", "or_before"}.
[[nodiscard]] nlohmann::json attached_json(std::span<const Attached> attached);

// Returns, for example, "part is attached to hand, contact lift is allowed". Empty: objects,
// carriers and contacts have the same names in both scenes.
[[nodiscard]] std::string changes_text(const Scene& before, const Scene& after);

}  // namespace clearance::view
