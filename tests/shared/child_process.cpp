#include "tests/shared/child_process.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/shared/eventually.hpp"

namespace clearance::test {

namespace {

void set_up(const ChildOptions& options, int output) {
  for (const char* name : {"CYCLONEDDS_URI", "ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE",
                           "ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS", "ROS_DISTRO"})
    unsetenv(name);
  for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
  if (options.most_file_bytes) {
    const rlimit limit{*options.most_file_bytes, *options.most_file_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (options.most_descriptors) {
    const rlimit limit{*options.most_descriptors, *options.most_descriptors};
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  std::signal(SIGHUP, SIG_DFL);  // nohup, below which the tests may run, has it ignored
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(options.out < 0 ? output : options.out, STDOUT_FILENO);
  dup2(options.err < 0 ? output : options.err, STDERR_FILENO);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, std::vector<std::string> arguments,
                           const ChildOptions& options) {
  char name[] = "/tmp/clearance-test-XXXXXX";
  const int output = mkstemp(name);
  output_file_ = name;
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    set_up(options, output);
    execv(program.c_str(), argv.data());
    std::perror(program.c_str());
    _exit(127);
  }
  close(output);
}

ChildProcess::~ChildProcess() {
  if (running()) {
    kill(pid_, SIGKILL);
    wait();
  }
  std::remove(output_file_.c_str());
}

void ChildProcess::signal(int number) const {
  if (!status_) kill(pid_, number);
}

int ChildProcess::wait(std::chrono::seconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (running()) {
    if (std::chrono::steady_clock::now() > end) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return *status_;
}

bool ChildProcess::running() {
  if (status_) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return false;
}

std::string ChildProcess::output() const {
  std::ostringstream text;
  text << std::ifstream(output_file_).rdbuf();
  return text.str();
}

bool ChildProcess::wrote(const std::string& text) const {
  return output().find(text) != std::string::npos;
}

bool ChildProcess::told(const std::string& code, const std::vector<std::string>& names) const {
  std::istringstream lines(output());
  for (std::string line; std::getline(lines, line);) {
    const auto has = [&](const std::string& name) { return line.find(name) != line.npos; };
    if (line.ends_with(" [" + code + "]") && std::ranges::all_of(names, has)) return true;
  }
  return false;
}

bool ChildProcess::tells(const std::string& code, const std::vector<std::string>& names) const {
  return eventually([&] { return told(code, names); });
}

}  // namespace clearance::test
