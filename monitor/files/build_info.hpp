// The name of this build. Two builds of one name compute the same bits.
#pragma once

namespace clearance {

// Version, git's name of the sources, compiler, kind of build, a hash of the compiler's flags:
// "0.2.0, 5dbd42e01a7c, GNU 12.2.0, Release, flags 1a2b3c4d". It depends neither on the time nor
// on the place of the build.
extern const char* const kBuild;

}  // namespace clearance
