// Runs one of this project's programs as a user starts it: in a process of its own, with its output
// kept.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

namespace clearance::test {

// Everything that may differ from the defaults.
struct ChildOptions {
  // descriptors for the two output streams; -1 stands for the file that is kept
  int out = -1, err = -1;
  // variables added to the environment
  std::vector<std::pair<std::string, std::string>> environment = {};
  // limit of a file's size, which simulates a full disk
  std::optional<std::size_t> most_file_bytes = {};
  // limit of the number of open files and connections
  std::optional<std::size_t> most_descriptors = {};
};

class ChildProcess {
 public:
  // Starts the program at once. `program` is a path. Both output streams go to one file.
  ChildProcess(const std::string& program, std::vector<std::string> arguments,
               const ChildOptions& options = {});
  ~ChildProcess();  // kills the process if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  void signal(int number) const;
  // Returns the exit status, 128 + the signal that ended the process, or -1 if it still runs after
  // the limit.
  int wait(std::chrono::seconds limit = std::chrono::seconds(60));
  [[nodiscard]] bool running();
  // The output written so far.
  [[nodiscard]] std::string output() const;
  [[nodiscard]] bool wrote(const std::string& text) const;
  // Returns true if the program has logged a line with this code (monitor/interface/log_lines.hpp)
  // that contains all of these names.
  [[nodiscard]] bool told(const std::string& code,
                          const std::vector<std::string>& names = {}) const;
  // Waits until it has: a program logs beside its other work, and may be late with a line.
  [[nodiscard]] bool tells(const std::string& code,
                           const std::vector<std::string>& names = {}) const;

 private:
  std::string output_file_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace clearance::test
