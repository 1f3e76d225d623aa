// Why a file gives no mesh.
#pragma once

#include <string>

namespace clearance {

// `reason` ends a sentence: "a vertex is not finite".
struct MeshFault {
  std::string reason;
};

}  // namespace clearance
