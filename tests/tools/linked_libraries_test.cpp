// The libraries that programs need: a program that does not communicate with a daemon needs no DDS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <string>

#include "tests/shared/places.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;

// The libraries that a program names for the loader, and their own dependencies.
std::string libraries_of(const std::string& program) {
  const std::string command = "ldd " + test::places::programs() + "/" + program;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(popen(command.c_str(), "r"), pclose);
  std::string text;
  for (int c = std::getc(output.get()); c != EOF; c = std::getc(output.get())) {
    text += static_cast<char>(c);
  }
  return text;
}

TEST(LinkedLibraries, AProgramThatReadsNoMessagesDoesWithoutDds) {
  const std::string libraries = libraries_of("clearance-distance");
  EXPECT_THAT(libraries, HasSubstr("libgmp"));
  EXPECT_THAT(libraries, Not(HasSubstr("libddsc")));
  EXPECT_THAT(libraries_of("clearance-watch"), HasSubstr("libddsc"));
}

}  // namespace
}  // namespace clearance
