// clearance-view: a cell live in a browser, and in viewers of Foxglove's protocol.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include "monitor/app/cell_arguments.hpp"
#include "monitor/app/log.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/files/temporary_folder.hpp"
#include "monitor/loop/ports.hpp"
#include "tools/shared/progress_bar.hpp"
#include "tools/view/allowed_hosts.hpp"
#include "tools/view/browser.hpp"
#include "tools/view/live_source.hpp"
#include "tools/view/offline_recording.hpp"
#include "tools/view/page_files.hpp"
#include "tools/view/recording_source.hpp"
#include "tools/view/scene_json.hpp"
#include "tools/view/visuals.hpp"

namespace clearance {
namespace {

using view::Server;
using view::Source;

constexpr std::int64_t kFrameNs = 1'000'000'000 / 60;
constexpr std::size_t kMostCurves = 64;  // pairs that a page may ask for at once
constexpr double kLongest_s = 1e9;       // times that a page may ask for

constexpr const char* kFooter =
    R"(Open the printed address in a browser; Ctrl-C ends the program. Foxglove, Lichtblick and other
viewers of their protocol connect to the same address with ws:// instead of http://. Every program
that reaches the port may watch and move a recording's time, and can change nothing else. Pages of
other servers get no answer: --allow states those that do.

Exit status:
  0  stopped by SIGINT, SIGTERM or SIGHUP, or all screenshots are written
  1  the port cannot be used, the recording cannot be read, or the browser gave no picture
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  stopped by SIGINT, SIGTERM or SIGHUP while a recording was being read

Examples:
  clearance-view cell.yaml
  clearance-view --urdf panda.urdf --srdf panda.srdf
  clearance-view cell.yaml --replay run.mcap
  clearance-view cell.yaml --replay poses.mcap --offline
  clearance-view cell.yaml --replay run.mcap --screenshot worst.png --at 12.5
  clearance-view cell.yaml --host 0.0.0.0 --allow robot.example
  clearance-view cell.yaml --metrics /run/clearance/metrics.sock)";

struct Arguments {
  CellArguments cell;
  std::string recording;
  bool offline = false;
  std::string host = "127.0.0.1";
  std::uint16_t port = 8765;
  std::vector<std::string> allowed;  // hosts and origins
  std::string metrics;               // the daemon's socket
  std::vector<std::string> screenshots;
  std::vector<double> at_s;
  std::string query;  // of the page in pictures
  int width = 1440, height = 900;
  bool force = false;
  DdsArguments dds;
};

void add_options(CommandLine& line, Arguments& arguments) {
  const OptionRule picture{.needs = {"--screenshot"}, .group = "Pictures"};
  const OptionRule shown_of_picture{.shows_default = true, .group = picture.group};
  arguments.cell.add_to(line);
  line.add({
      {"--replay", &arguments.recording,
       "Show this recording (MCAP) with a time line, instead of a daemon"},
      {"--offline", &arguments.offline,
       "Compute the reports from the recording's inputs with this cell, instead of showing the "
       "recorded ones",
       needing("--replay")},
      {"--host", &arguments.host,
       "Address to serve on; any other than loopback opens it to the network", shown()},
      {"--port", &arguments.port, "Port to serve on; 0: a free one", shown()},
      {"--allow", &arguments.allowed,
       "Also answer requests for this host and by its pages: NAME or NAME:PORT; or pages of this "
       "origin: https://NAME; repeatable",
       Check{view::fault_of_allowed}},
      {"--metrics", &arguments.metrics,
       "Also serve /metrics for Prometheus: those of the daemon on this machine whose option "
       "--metrics names this Unix socket",
       excluding("--replay")},
      {"--screenshot",
       &arguments.screenshots,
       "Write a picture of the page (PNG) by Debian's chromium, and end; repeatable",
       {.takes_all = true, .group = picture.group}},
      {"--at",
       &arguments.at_s,
       "Time of a picture, s: after the first report of a recording, or after the page is loaded; "
       "one for each --screenshot",
       number_from_zero(),
       {.takes_all = true, .needs = picture.needs, .group = picture.group}},
      {"--query", &arguments.query,
       "The query of the page's address, with the words of a link, e.g. "
       "'robots=looks&theme=light'",
       picture},
      {"--width", &arguments.width, "Pixels", whole_number_in(320, 7680), shown_of_picture},
      {"--height", &arguments.height, "Pixels", whole_number_in(240, 4320), shown_of_picture},
      force_option(arguments.force),
  });
  arguments.dds.add_to(line);
}

// Returns null and says why when the recording cannot be shown.
std::unique_ptr<Source> recording_source(const std::shared_ptr<const Cell>& cell,
                                         const Arguments& arguments,
                                         std::optional<TemporaryFolder>& scratch,
                                         StopSignal& stop) {
  std::filesystem::path file = arguments.recording;
  ProgressBar bar;
  if (arguments.offline) {
    scratch.emplace();
    if (!scratch->error().empty()) throw std::runtime_error(scratch->error());
    const std::filesystem::path computed = *scratch / "replay.mcap";
    const std::string error = view::replay_into(
        *cell, file, computed, [&bar](double share) { bar.show(share, "replayed"); },
        [&stop] { return stop.wait(0); });
    bar.finish();
    if (!error.empty()) {
      print(stderr, "clearance-view: {}\n", error);
      return nullptr;
    }
    file = computed;
  }
  auto scenes = std::make_unique<SceneHistory>(*cell, std::vector{file}, [](Scene&) {});
  view::Timeline timeline = view::read_timeline(*scenes, file);
  if (!timeline.error.empty()) {
    print(stderr, "clearance-view: {}\n", timeline.error);
    return nullptr;
  }
  return std::make_unique<view::RecordingSource>(cell, std::move(scenes), file,
                                                 std::move(timeline));
}

view::Resource resource(std::string type, std::string body) {
  return {std::move(type), std::make_shared<const std::string>(std::move(body))};
}

// The page's files and the time line, each made once.
std::map<std::string, view::Resource> resources(const Source& source) {
  std::map<std::string, view::Resource> all;
  for (const view::PageFile& file : view::page_files()) {
    all[std::string(file.path)] =
        resource(std::string(view::content_type(file.path)), std::string(file.text));
  }
  all["/"] = all["/index.html"];
  all["/timeline.json"] = resource("application/json", source.timeline());
  return all;
}

// The values of "a=3&b=17" by their names, as texts.
std::map<std::string, std::string> fields_of(const std::string& query) {
  std::map<std::string, std::string> fields;
  std::istringstream all(query);
  for (std::string field; std::getline(all, field, '&');) {
    const std::size_t equals = std::min(field.find('='), field.size());
    fields[field.substr(0, equals)] = field.substr(std::min(equals + 1, field.size()));
  }
  return fields;
}

// The number from 0 to `most` that a text begins with; else `without`.
double number_of(const std::string& text, double most, double without) {
  const double value = text.empty() ? without : std::strtod(text.c_str(), nullptr);
  return std::isfinite(value) ? std::clamp(value, 0.0, most) : without;
}

// "end=12.5&width=30&pairs=3,17": s after the first report, and s.
view::Resource history(const Source& source, const std::string& query) {
  auto fields = fields_of(query);
  std::vector<std::uint32_t> pairs;
  std::istringstream list(fields["pairs"]);
  for (std::uint32_t pair = 0; list >> pair && pairs.size() < kMostCurves; list.ignore()) {
    pairs.push_back(pair);
  }
  return resource("application/json",
                  source.history(number_of(fields["end"], kLongest_s, 0.0),
                                 number_of(fields["width"], kLongest_s, 30.0), pairs));
}

// "a=3&b=17": numbers of two objects.
view::Resource distance(Source& source, const std::string& query) {
  auto fields = fields_of(query);
  constexpr double kNone = std::numeric_limits<std::uint32_t>::max();
  const auto object = [&](const char* name) {
    return static_cast<std::uint32_t>(number_of(fields[name], kNone, kNone));
  };
  return resource("application/json", source.distance(object("a"), object("b")));
}

// The bodies that the page draws of the present cell.
class Drawn {
 public:
  explicit Drawn(const Source& source) : source_(source) {}
  [[nodiscard]] view::Resource scene() {
    update();
    return scene_;
  }
  [[nodiscard]] view::Resource visuals() {
    update();
    return visuals_->get();
  }

 private:
  void update() {
    if (cell_ == source_.cell()) return;
    visuals_.reset();
    cell_ = source_.cell();
    scene_ = resource("application/json", view::scene_json(*cell_, view::link_colours(*cell_)));
    visuals_.emplace(*cell_);
  }

  const Source& source_;
  std::shared_ptr<const Cell> cell_;
  view::Resource scene_;
  std::optional<view::Visuals> visuals_;
};

// The page loads the cell again when its revision changes.
nlohmann::json parameters_of(const Source& source) {
  nlohmann::json all = source.parameters();
  all.push_back(
      {{"name", "scene.revision"}, {"value", std::to_string(source.cell()->scene.revision)}});
  return all;
}

view::Content content_of(const Cell& cell, Source& source, Drawn& drawn,
                         const std::string& metrics) {
  return {.name = cell.scene.name,
          .channels = view::channels_of(cell.topics),
          .get =
              [found = resources(source), &source, &drawn](const std::string& path,
                                                           const std::string& query) {
                if (path == "/history.json") return history(source, query);
                if (path == "/distance.json") return distance(source, query);
                if (path == "/sensors.json") return resource("application/json", source.sensors());
                if (path == "/visuals.bin") return drawn.visuals();
                if (path == "/scene.json") return drawn.scene();
                const auto entry = found.find(path);
                return entry == found.end() ? view::Resource{} : entry->second;
              },
          .parameters = [&source] { return parameters_of(source); },
          .set_parameter = [&source](const std::string& name,
                                     const nlohmann::json& value) { source.set(name, value); },
          .metrics = metrics};
}

// One frame: sends everything new, then lets the server work until the next frame is due.
class Frames {
 public:
  Frames(Server& server, Source& source) : server_(server), source_(source) {}
  void next() {
    source_.advance(server_);
    due_ns_ += kFrameNs;
    const std::int64_t now_ns = clock_.monotonic_ns();
    if (due_ns_ < now_ns) due_ns_ = now_ns;
    server_.run_for(std::max<std::int64_t>(due_ns_ - now_ns, 1'000'000));
  }

 private:
  Server& server_;
  Source& source_;
  SystemClock clock_;
  std::int64_t due_ns_ = 0;
};

int take_screenshots(const Arguments& arguments, Server& server, Source& source) {
  Frames frames(server, source);
  view::Browser browser(arguments.width, arguments.height, [&frames] { frames.next(); });
  for (std::size_t i = 0; i < arguments.screenshots.size(); ++i) {
    const double at_s = i < arguments.at_s.size() ? arguments.at_s[i] : 0.0;
    const bool is_live = arguments.recording.empty();
    browser.open(fmt::format("{}?{}&{}", server.address(), arguments.query,
                             is_live ? "live" : fmt::format("t={}", at_s)));
    browser.wait_for(is_live ? fmt::format("window.clearance?.shownFor() > {}", at_s)
                             : fmt::format("window.clearance?.isAt({})", at_s));
    browser.screenshot(arguments.screenshots[i]);
    print(stdout, "{}\n", arguments.screenshots[i]);
  }
  return kOk;
}

int serve(const Arguments& arguments, Server& server, Source& source, StopSignal& stop) {
  print(stdout, "{}\n", server.address());
  std::fflush(stdout);
  if (arguments.host != "127.0.0.1" && arguments.host != "localhost" && arguments.host != "::1") {
    print(stderr,
          "clearance-view: OPEN TO THE NETWORK: whoever reaches {} sees this cell; there is no "
          "password and no encryption\n",
          server.address());
  }
  Frames frames(server, source);
  while (!stop.wait(0)) frames.next();
  return kOk;
}

int run_view(const std::shared_ptr<const Cell>& cell, const Arguments& arguments,
             StopSignal& stop) {
  std::optional<TemporaryFolder> scratch;
  std::unique_ptr<Source> source;
  if (arguments.recording.empty()) {
    route_dds_log();
    source = std::make_unique<view::LiveSource>(cell, arguments.dds.resolve(*cell));
  } else {
    source = recording_source(cell, arguments, scratch, stop);
    if (!source) return kFailed;
    if (stop.wait(0)) return kIncomplete;
  }
  const bool pictures = !arguments.screenshots.empty();
  Drawn drawn(*source);
  Server server(arguments.host, pictures ? std::uint16_t{0} : arguments.port, arguments.allowed,
                content_of(*cell, *source, drawn, arguments.metrics));
  return pictures ? take_screenshots(arguments, server, *source)
                  : serve(arguments, server, *source, stop);
}

int run(int argc, char** argv, StopSignal& stop) {
  CommandLine line{"Shows a cell in a browser: live, or from a recording.", kFooter};
  Arguments arguments;
  add_options(line, arguments);
  if (const auto done = parse(line, argc, argv)) return *done;
  for (const std::string& picture : arguments.screenshots) {
    std::vector<std::filesystem::path> inputs = arguments.cell.files();
    inputs.emplace_back(arguments.recording);
    for (const std::filesystem::path& input : inputs) {
      if (!output_is_not_an_input("clearance-view", picture, {input})) return kUsage;
    }
    if (!can_create("clearance-view", picture, arguments.force)) return kFailed;
  }
  start_log("clearance-view", "error");
  auto cell = cell_or_errors(arguments.cell.read());
  if (!cell) return kBadCell;
  return run_view(std::make_shared<const Cell>(*std::move(cell)), arguments, stop);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-view", [=](auto& stop) { return clearance::run(argc, argv, stop); },
      clearance::dds_exit_code);
}
