#include "tools/bench/suite/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>

#include "monitor/app/print.hpp"
#include "tools/bench/suite/rivals.hpp"
#include "tools/shared/progress_bar.hpp"

namespace clearance::bench {
namespace {

constexpr const char* kHelp =
    R"(clearance-bench --suite measures Clearance and other libraries on one set of cases with exact answers.
It writes suite.md (table), suite.csv (every separation) and suite.svg (error against time).

Usage: clearance-bench --suite [OPTIONS]
  --out FOLDER    where the three files go (build/suite)
  --class NAME    only this class of cases; repeatable
  --rival NAME    only this rival, beside Clearance; repeatable
  --passes N      passes over all cases; the least time of each query counts (7)
  --motions N     pairs of bodies for each class and separation (8)
  --steps N       poses of each motion, 2 to 100 (60)
  --list          print the classes, and the rivals with their settings

Debian packages FCL, Bullet and libccd (tools/setup --bench). Other rivals are used from the folder in which they are
installed: cmake -DCLEARANCE_BENCH_COAL=FOLDER, _OPENGJK, _VCLIP, _JOLT, _BOX3D, _MUJOCO.
tools/bench/suite/README.md says what is expected there.

Examples:
  clearance-bench --suite --out build/suite
  clearance-bench --suite --class 'level, sliding' --class cones --passes 3
)";

struct Arguments {
  std::filesystem::path out = "build/suite";
  std::vector<std::string> kinds, rivals;
  RaceOptions race;
  bool help = false, list = false;
};

// Returns an empty text, or what is wrong.
std::string read_count(const std::string& word, int least, int most, int& into) {
  int value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc{} || end != word.data() + word.size() || value < least || value > most) {
    return fmt::format("found '{}'; expected a number from {} to {}", word, least, most);
  }
  into = value;
  return {};
}

std::string read(std::span<const std::string> words, Arguments& into) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--help" || word == "-h" || word == "--list") {
      (word == "--list" ? into.list : into.help) = true;
      continue;
    }
    if (i + 1 == words.size()) return fmt::format("'{}' is no option, or lacks its value", word);
    const std::string& value = words[++i];
    std::string fault;
    if (word == "--out") {
      into.out = value;
    } else if (word == "--class") {
      into.kinds.push_back(value);
    } else if (word == "--rival") {
      into.rivals.push_back(value);
    } else if (word == "--passes") {
      fault = read_count(value, 1, 1000, into.race.passes);
    } else if (word == "--motions") {
      fault = read_count(value, 1, 40, into.race.motions);
    } else if (word == "--steps") {
      fault = read_count(value, 2, kTrajectorySteps, into.race.steps);
    } else {
      return fmt::format("there is no option '{}'", word);
    }
    if (!fault.empty()) return fmt::format("{}: {}", word, fault);
  }
  return {};
}

// Keeps the rivals that were asked for, and Clearance. Returns an empty text, or what is wrong.
std::string keep(const std::vector<std::string>& asked, std::vector<Rival>& rivals) {
  for (const std::string& name : asked) {
    if (std::ranges::find(rivals, name, &Rival::name) == rivals.end()) {
      return fmt::format("there is no rival '{}' in this build; --list has all", name);
    }
  }
  if (asked.empty()) return {};
  std::erase_if(rivals, [&](const Rival& rival) {
    return &rival != &rivals.front() && std::ranges::find(asked, rival.name) == asked.end();
  });
  return {};
}

void list(std::span<const Rival> rivals) {
  print(stdout, "classes:\n");
  for (const std::string& kind : suite_kinds()) print(stdout, "  {}\n", kind);
  print(stdout, "rivals:\n");
  for (const Rival& rival : rivals) print(stdout, "  {}: {}\n", rival.name, rival.setting);
}

bool write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) print(stderr, "{} cannot be written\n", file.string());
  return static_cast<bool>(stream);
}

}  // namespace

int run_suite(std::span<const std::string> words) {
  Arguments arguments;
  std::vector<Rival> rivals = all_rivals();
  std::string fault = read(words, arguments);
  if (fault.empty()) fault = keep(arguments.rivals, rivals);
  std::vector<std::string> kinds = arguments.kinds;
  for (const std::string& kind : kinds) {
    const std::vector<std::string> all = suite_kinds();
    if (fault.empty() && std::ranges::find(all, kind) == all.end()) {
      fault = fmt::format("there is no class '{}'; --list has all", kind);
    }
  }
  if (!fault.empty()) {
    print(stderr, "clearance-bench --suite: {}\n", fault);
    return 2;
  }
  if (arguments.help) {
    print(stdout, "{}", kHelp);
    return 0;
  }
  if (arguments.list) {
    list(rivals);
    return 0;
  }
  if (kinds.empty()) kinds = suite_kinds();
  std::error_code ignored;
  std::filesystem::create_directories(arguments.out, ignored);
  std::vector<RaceRow> rows;
  {
    ProgressBar bar;
    rows = race(rivals, kinds, arguments.race,
                [&](double share, const std::string& what) { bar.show(share, what + "      "); });
  }
  if (!write(arguments.out / "suite.csv", suite_csv(rows, rivals)) ||
      !write(arguments.out / "suite.md", suite_page(rows, rivals, arguments.race))) {
    return 1;
  }
  if (const std::string why = draw_suite(arguments.out / "suite.svg", rows, rivals); !why.empty()) {
    print(stderr, "clearance-bench --suite: {}\n", why);
    return 1;
  }
  print(stderr, "written: suite.md, suite.csv and suite.svg in {}\n", arguments.out.string());
  return 0;
}

}  // namespace clearance::bench
