// A program of ours as a user starts it: a process of its own, its output kept.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

namespace clearance::test {

// What is not as usual.
struct ChildOptions {
  int out = -1, err = -1;  // descriptors for the two output streams; -1: the file that is kept
  std::vector<std::pair<std::string, std::string>> environment = {};  // added
  std::optional<std::size_t> most_file_bytes = {};  // that a file may get: a disk that is full
};

class ChildProcess {
 public:
  // Starts at once. `program` is a path; both output streams go to one file.
  ChildProcess(const std::string& program, std::vector<std::string> arguments,
               const ChildOptions& options = {});
  ~ChildProcess();  // kills it if it still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const;
  // The exit status; 128 + the signal that ended it; -1 when it still runs after the limit.
  int wait(std::chrono::seconds limit = std::chrono::seconds(60));
  [[nodiscard]] bool running();
  // What it has written so far.
  [[nodiscard]] std::string output() const;
  [[nodiscard]] bool wrote(const std::string& text) const;
  // Whether it has logged a line with this code (monitor/app/log_lines.hpp) that names all of
  // these.
  [[nodiscard]] bool told(const std::string& code,
                          const std::vector<std::string>& names = {}) const;

 private:
  std::string output_file_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace clearance::test
