// clearance-watch: shows the daemon's reports live in a terminal.
#include <fmt/format.h>

#include <cstdio>

#include "monitor/app/log.hpp"
#include "monitor/app/options.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/dds/dds_arguments.hpp"
#include "monitor/dds/dds_log.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/wire/topics.hpp"
#include "tools/watch/feed.hpp"
#include "tools/watch/view.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kFrameMs = 100;
constexpr std::int64_t kPlainNs = 1'000'000'000;

constexpr const char* kFooter = R"(Ctrl-C ends it, and q in the full screen.

Exit status:
  0  stopped by SIGINT, SIGTERM, SIGHUP, q or --seconds
  1  something else failed
  2  wrong usage
  3  the cell file is wrong
  4  DDS could not be joined
  5  no report was received

Examples:
  clearance-watch --partition lab --seconds 10
  clearance-watch cell.yaml)";

struct Arguments {
  double seconds = 0.0;
  bool plain = false;
  std::filesystem::path cell;
  DdsArguments dds;
};

void add_options(CommandLine& line, Arguments& arguments) {
  line.add({
      {"CELL", &arguments.cell, "A cell file, which names domain, partition, interface and topics"},
      {"--seconds", &arguments.seconds, "Stop after this time; 0: run until Ctrl-C",
       number_from_zero()},
      {"--plain", &arguments.plain,
       "Print one line per second instead of a full screen; the default without a terminal"},
  });
  arguments.dds.add_to(line);
}

// Shows the feed ten times a second on a screen, or once per second in plain lines.
class Display {
 public:
  Display(bool plain, std::string where) : where_(std::move(where)) {
    if (!plain && watch::Screen::available()) screen_.emplace();
  }

  void show(const watch::Feed& feed, std::int64_t now_ns) {
    measure_rate(feed, now_ns);
    if (!feed.any() || begun_ns_ == 0) begun_ns_ = now_ns;
    watch::ViewContext context{.where = where_, .now_ns = now_ns, .reports_a_second = rate_};
    if (screen_) {
      screen_->draw(watch::screen_lines(feed, context, screen_->size()));
    } else if (now_ns - shown_ns_ >= kPlainNs) {
      // Without a catalogue, objects have no names yet.
      if (feed.any() && feed.catalogue() == nullptr && now_ns - begun_ns_ < kPlainNs) return;
      shown_ns_ = now_ns;
      for (std::size_t i = 0; i < partners_.size(); ++i)
        context.partner_counts[i] = feed.partner_counts()[i] - partners_[i];
      partners_ = feed.partner_counts();
      print(stdout, "{}\n", watch::plain_line(feed, context));
      std::fflush(stdout);
    }
  }
  [[nodiscard]] bool quit() { return screen_ && screen_->quit_key(); }
  void close() { screen_.reset(); }

 private:
  void measure_rate(const watch::Feed& feed, std::int64_t now_ns) {
    if (now_ns - counted_ns_ < 1'000'000'000) return;
    const auto seconds = 1e-9 * static_cast<double>(now_ns - counted_ns_);
    if (counted_ns_ != 0) rate_ = static_cast<double>(feed.reports() - counted_) / seconds;
    counted_ns_ = now_ns;
    counted_ = feed.reports();
  }

  std::string where_;
  std::optional<watch::Screen> screen_;
  std::int64_t shown_ns_ = 0, counted_ns_ = 0, begun_ns_ = 0;
  watch::PartnerCounts partners_{};  // up to the last plain line
  std::uint64_t counted_ = 0;
  double rate_ = 0.0;
};

int run_watch(const Arguments& arguments, StopSignal& signal) {
  const auto cell = cell_of_topics(arguments.cell);
  if (!cell) return kBadCell;
  route_dds_log();
  client::Connection connection(arguments.dds.resolve(*cell), cell->topics);
  watch::Feed feed(connection);
  Display display(arguments.plain, connection.where());
  SystemClock clock;
  const std::int64_t started = clock.monotonic_ns();
  double seconds = 0.0;
  do {
    feed.take(clock.realtime_ns());
    display.show(feed, clock.realtime_ns());
    seconds = 1e-9 * static_cast<double>(clock.monotonic_ns() - started);
  } while ((arguments.seconds == 0.0 || seconds < arguments.seconds) && !display.quit() &&
           !signal.wait(kFrameMs));
  display.close();
  print(stdout, "{}", watch::final_summary(feed, seconds, clock.realtime_ns()));
  return feed.any() ? kOk : kIncomplete;
}

int run(int argc, char** argv, StopSignal& signal) {
  CommandLine line{
      "Shows live how far apart the objects of a cell are, as clearanced publishes it.", kFooter};
  Arguments arguments;
  add_options(line, arguments);
  if (const auto done = parse(line, argc, argv)) return *done;
  start_log("clearance-watch", "error");
  return run_watch(arguments, signal);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  return clearance::run_program(
      "clearance-watch", [=](auto& signal) { return clearance::run(argc, argv, signal); },
      clearance::dds_exit_code);
}
