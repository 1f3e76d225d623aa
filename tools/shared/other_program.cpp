#include "tools/shared/other_program.hpp"

#include <sys/resource.h>

#include "tools/shared/child_process.hpp"

namespace clearance {
namespace {

constexpr rlim_t kMostFileBytes = rlim_t{64} << 20U;
constexpr std::size_t kMostSaid = 2000;

}  // namespace

// timeout of coreutils finds the program, ends its whole process group, and has the two statuses.
ProgramRun run_program(std::vector<std::string> words) {
  words.insert(words.begin(), {"--kill-after=5", std::to_string(kProgramSeconds)});
  bp::ipstream output;
  bp::child child(
      bp::exe = "/usr/bin/timeout", bp::args = words, (bp::std_out & bp::std_err) > output,
      bp::std_in < bp::null, bp::extend::on_exec_setup = [](auto&) {
        const rlimit limit{kMostFileBytes, kMostFileBytes};
        setrlimit(RLIMIT_FSIZE, &limit);
      });
  ProgramRun run;
  for (char c = 0; output.get(c);)
    if (run.said.size() < kMostSaid) run.said += c;
  child.wait();
  run.status = child.exit_code();
  return run;
}

}  // namespace clearance
