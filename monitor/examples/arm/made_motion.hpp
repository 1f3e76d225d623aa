// A motion that is made up, for a demonstration that needs no recording.
#pragma once

#include <cstdint>
#include <string>

namespace clearance::people {

// A BVH file of a person of 1.75 m, in cm, 30 frames a second: walks 1.5 m forward along z, leans
// and reaches out with the right hand, steps back, and does so again. The seed draws how far and
// how fast limbs swing. The proportions are not those of the daemon's skeleton, and the collar
// bones and the spine bend, which that skeleton cannot.
[[nodiscard]] std::string walking_and_reaching(std::uint32_t seed, int frames);

}  // namespace clearance::people
