// Starts a program of others, without a shell, and waits until it ends.
#pragma once

#include <string>
#include <vector>

namespace clearance {

inline constexpr int kNotInPath = 127, kOutOfTime = 124;  // statuses
inline constexpr int kProgramSeconds = 120;               // then it is ended

struct ProgramRun {
  int status = 0;
  std::string said;  // the first 2000 bytes of its output and its errors
};

// The first word is looked for in PATH. Its input is empty, and no file that it writes grows beyond
// 64 MiB.
[[nodiscard]] ProgramRun run_program(std::vector<std::string> words);

}  // namespace clearance
