// Codes of the warnings about meshes, for monitor/FAULTS.md. Each stands at the end of its line.
#pragma once

#include <array>
#include <string_view>

namespace clearance {

inline constexpr std::string_view kMeshFarFromParts = "mesh-far-from-parts",
                                  kPartsNotKept = "parts-not-kept", kPartsAgain = "parts-again";
inline constexpr std::array kMeshCodes{kMeshFarFromParts, kPartsNotKept, kPartsAgain};

}  // namespace clearance
