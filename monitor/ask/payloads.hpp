// Payloads of a question: a scene in which links carry them.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "config/scene/scene.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// Returns the scene with the payloads attached, or what is wrong with one. New objects come last;
// all others keep their indices. A payload has what the same object has as soon as a cell attaches
// it: the groups, pairs, zones and contacts of its link, errors, and its mass in the load for
// stops.
[[nodiscard]] std::variant<Scene, std::string> scene_with(const Scene& scene,
                                                          std::span<const Payload> payloads);

}  // namespace clearance
