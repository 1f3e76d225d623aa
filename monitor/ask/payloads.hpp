// Payloads of a question: a scene in which links carry them.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "config/scene/scene.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// Returns the scene with the payloads attached, or what is wrong with one. New objects come last;
// all others keep their indices. Zones with `separation` that limit a link limit its payload, too.
[[nodiscard]] std::variant<Scene, std::string> scene_with(const Scene& scene,
                                                          std::span<const Payload> payloads);

}  // namespace clearance
