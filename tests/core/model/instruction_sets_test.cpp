// One library serves every x86-64 machine: code that needs more than the baseline is selected at
// run time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>

#include "tests/shared/child_process.hpp"
#include "tests/shared/places.hpp"

namespace clearance {
namespace {

#ifdef __x86_64__

// The library's functions, by their mangled names, that contain instructions of AVX or later.
std::set<std::string> functions_beyond_the_baseline(std::istream& disassembly) {
  std::set<std::string> found;
  std::string line, function;
  while (std::getline(disassembly, line)) {
    if (line.ends_with(">:")) function = line.substr(line.find('<'));
    const std::size_t instruction = line.find(":\t");
    if (instruction != std::string::npos && line[instruction + 2] == 'v') found.insert(function);
  }
  return found;
}

TEST(InstructionSets, BeyondTheBaselineAreUsedOnlyWhereTheyArePickedAtRunTime) {
  test::ChildProcess objdump("/usr/bin/objdump",
                             {"-d", "--no-show-raw-insn", test::places::core_library()});
  ASSERT_EQ(objdump.wait(), 0) << objdump.output();
  std::istringstream disassembly(objdump.output());
  const std::set<std::string> found = functions_beyond_the_baseline(disassembly);
  EXPECT_FALSE(found.empty());
  for (const std::string& function : found) {
    EXPECT_THAT(function, ::testing::HasSubstr("N_AVX"));
  }
}

#endif

}  // namespace
}  // namespace clearance
