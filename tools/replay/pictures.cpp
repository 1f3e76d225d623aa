#include "tools/replay/pictures.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

namespace clearance {
namespace {

// Runs a program without its output. Returns its exit status, or -1 when it cannot be started.
int run_quietly(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  // The other program would inherit the blocked signals of this one.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t pid = -1;
  const int failed =
      posix_spawn(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  int status = 0;
  if (failed != 0 || waitpid(pid, &status, 0) != pid || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

}  // namespace

std::string take_pictures(const CheckArguments& arguments, const std::string& cell,
                          const std::vector<PicturedMoment>& moments) {
  if (moments.empty()) return "no pair was ever known";
  const auto view =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "clearance-view";
  if (!std::filesystem::exists(view)) return "clearance-view is not there, which takes them";
  std::vector<std::string> words = {view.string(), cell,      "--replay", arguments.recording(),
                                    "--offline",   "--force", "--query",  "theme=light"};
  for (const PicturedMoment& moment : moments) {
    words.insert(words.end(),
                 {"--screenshot", moment.picture.string(), "--at", std::to_string(moment.time_s)});
  }
  return run_quietly(words) == 0 ? "" : "clearance-view could not take them; it needs chromium";
}

}  // namespace clearance
