// The folders and files of the build under test. Only places.cpp is compiled with their paths, so
// that a compiler cache serves every folder that the sources lie in.
#pragma once

#include <string>

namespace clearance::test::places {

std::string sources();        // the top folder of the sources
std::string programs();       // the folder of the built programs
std::string core_library();   // the library of the core
std::string mcap_js();        // the scripts that call the official reader and writer of MCAP
std::string view_js();        // the scripts that drive the page in a browser
std::string view_pictures();  // the folder for the browser's pictures
// Libraries to preload that imitate a disk that hangs and a clock that is stepped. Empty with
// sanitizers.
std::string hanging_disk();
std::string stepped_clock();
std::string failing_memory();

}  // namespace clearance::test::places
