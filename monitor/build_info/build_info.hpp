// The name of this build: two builds of one name compute the same bits.
#pragma once

namespace clearance {

// Version, state of the sources as git names it, compiler, kind of build, a hash of the compiler's
// flags: "0.1.0, 5dbd42e01a7c, GNU 12.2.0, Release, flags 1a2b3c4d". Nothing that depends on when
// or where it was made.
extern const char* const kBuild;

}  // namespace clearance
