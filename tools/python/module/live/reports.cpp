// clearance.Reports: monitor/client/client.hpp.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "monitor/client/client.hpp"
#include "tools/python/module/live/connection.hpp"
#include "tools/python/module/live/live.hpp"
#include "tools/python/module/live/report.hpp"
#include "tools/python/module/live/tick_messages.hpp"

namespace clearance::python {
namespace {

struct ReportParts {
  ReportParts(SharedConnection joined, const client::StreamOptions& options, bool with_gradients,
              bool with_separation)
      : connection(std::move(joined)),
        stream(*connection, options),
        catalogue(*connection),
        zones(*connection),
        health(*connection) {
    if (with_gradients) gradients.emplace(*connection, options);
    if (with_separation) separations.emplace(*connection, options);
  }

  SharedConnection connection;
  client::Reports stream;
  ReportCheck check;  // of the stream's report, and what those said that were passed over before it
  bool is_first = true;
  client::Catalogue catalogue;
  client::Zones zones;
  client::Health health;
  std::optional<TickMessages<clearance_msg_Gradients>> gradients;
  std::optional<TickMessages<clearance_msg_Separation>> separations;
  KnownNames names;
};

// Joins the judgements of reports, separations and gradients: two faults of one hold all.
struct Judged {
  ReportParts& parts;

  template <class Use>
  void for_each(const Use& use) const {
    use(parts.stream);
    if (parts.separations) use(parts.separations->stream());
    if (parts.gradients) use(parts.gradients->stream());
  }
  [[nodiscard]] bool is_held() const {
    bool held = false;
    for_each([&](const auto& stream) { held = held || stream.is_held(); });
    return held;
  }
  [[nodiscard]] ReportError reason() const {
    ReportError reason = parts.stream.reason();
    for_each([&](const auto& stream) {
      if (reason == ReportError::kGood && stream.is_held()) reason = stream.reason();
    });
    return reason;
  }
  [[nodiscard]] bool fail_safe() const { return reason() != ReportError::kGood; }
  void acknowledge() {
    for_each([](auto& stream) { stream.acknowledge(); });
  }
};

std::shared_ptr<const Names> names_of(ReportParts& parts, std::uint64_t revision) {
  if (auto known = parts.names.of(revision)) return known;
  parts.catalogue.update();
  return parts.names.of(revision, parts.catalogue.message(revision));
}

// Names may come a little later than the first reports of a scene, on another topic. Those are
// passed over, since nothing can be found in them.
bool take_named(ReportParts& parts, bool newest, std::chrono::nanoseconds timeout) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + timeout;
  client::Reports& stream = parts.stream;
  for (;;) {
    const auto left = std::max(end - Clock::now(), Clock::duration::zero());
    if (!(newest ? stream.newest(left) : stream.next(left))) return false;
    const ReportCheck before = std::exchange(parts.check, stream.check());
    parts.check.other_daemon |= before.other_daemon;
    parts.check.other_scene |= before.other_scene;
    parts.check.missed += before.missed;
    const auto has_names = [&] {
      return parts.catalogue.message(stream->scene_revision) != nullptr;
    };
    if (has_names()) return true;
    parts.catalogue.update();
    if (has_names()) return true;
    ++parts.check.missed;
  }
}

class Reports : public Live<ReportParts> {
 public:
  Reports(const SharedConnection& connection, double old_after_s, std::int32_t depth,
          bool gradients, bool separation, const std::optional<double>& period_s,
          double error_interval_s)
      : Live("Reports", connection_of(connection),
             options(old_after_s, depth, period_s, error_interval_s), gradients, separation) {}

  // None when the time is over.
  py::object wait(bool newest, const std::optional<double>& timeout_s) {
    const Use parts = use();
    bool came = false;
    Beside beside;
    {
      const Unlocked unlock;
      using Clock = std::chrono::steady_clock;
      const auto end = timeout_s ? Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                      std::chrono::duration<double>(*timeout_s))
                                 : Clock::time_point::max();
      came = wait_in_slices(timeout_s, [&](std::chrono::nanoseconds slice) {
        return take_named(*parts, newest, slice);
      });
      const clearance_msg_Distances& report = *parts->stream;
      if (came && parts->gradients) beside.gradients = parts->gradients->of(report, end);
      if (came && parts->separations) beside.separation = parts->separations->of(report, end);
    }
    if (!came) return py::none();
    const clearance_msg_Distances& report = *parts->stream;
    ReportCheck check = std::exchange(parts->check, {});
    if (std::exchange(parts->is_first, false))
      check.other_daemon = check.other_scene = false, check.missed = 0;
    return py::cast(report_of(report, check, parts->stream.partner().state,
                              names_of(*parts, report.scene_revision), beside));
  }

  // States of zones of other daemons than that of the last report are left out, but for partners.
  py::dict zones() {
    const Use parts = use();
    const clearance_msg_Distances& last = *parts->stream;
    parts->zones.update();
    if (last.daemon != 0 && *last.partner == '\0') parts->zones.keep_only(last.daemon);
    if (last.cycle == 0) return zones_of(parts->zones.states(), py::list());
    parts->zones.update(last);
    const auto names = names_of(*parts, last.scene_revision);
    return zones_of(parts->zones.states(), names ? names->zones : py::list());
  }
  py::object health() {
    const Use parts = use();
    parts->health.update();
    const clearance_msg_Health* const message = parts->health.message();
    return message == nullptr ? py::object(py::none()) : health_of(*message);
  }

 private:
  static client::StreamOptions options(double old_after_s, std::int32_t depth,
                                       const std::optional<double>& period_s,
                                       double error_interval_s) {
    client::StreamOptions options{.old_after = seconds_of(old_after_s, "old_after_s"),
                                  .depth = depth};
    if (depth < 1 || depth > 100'000) throw py::value_error("depth: expected 1 to 100000 messages");
    if (period_s) options.period = seconds_of(*period_s, "period_s");
    options.error_interval = seconds_of(error_interval_s, "error_interval_s");
    return options;
  }
};

}  // namespace

void add_reports(py::module_& module) {
  py::class_<Reports> reports(module, "Reports", R"(The reports of a running daemon.

Iterating waits for each in order, without an end. Reports come once the names of their scene have come.
One thread uses it at a time. Waits release the interpreter's lock, and Ctrl-C ends them.)");
  reports
      .def(
          py::init<const SharedConnection&, double, std::int32_t, bool, bool,
                   const std::optional<double>&, double>(),
          py::arg("connection") = py::none(), py::kw_only(), py::arg("old_after_s") = 0.1,
          py::arg("depth") = 64, py::arg("gradients") = false, py::arg("separation") = false,
          py::arg("period_s") = py::none(), py::arg("error_interval_s") = 3600.0,
          R"(connection: None: one without arguments, on this machine's loopback. old_after_s: a report that
is older is not fresh, s. depth: messages that may wait. gradients, separation: reports have these of their tick,
where the cell asks for them. period_s: a good report counts so long after it was published, s; None: twice the period
that it states. error_interval_s: two faulty reports within it hold `fail_safe` until acknowledge(), s.
Raises ValueError and DdsError.)")
      .def(
          "next",
          [](Reports& self, const std::optional<double>& timeout) {
            return self.wait(false, timeout_of(timeout));
          },
          py::arg("timeout") = py::none(),
          "The next report in order; None if none came within `timeout` s (None: no end).")
      .def(
          "newest",
          [](Reports& self, const std::optional<double>& timeout) {
            return self.wait(true, timeout_of(timeout));
          },
          py::arg("timeout") = py::none(),
          "The newest waiting report, for a controller; waits like next() if none waits.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", [](Reports& self) { return self.wait(false, std::nullopt); })
      .def_property_readonly(
          "daemons", [](Reports& self) { return self.use()->stream.daemons(); },
          "The number of daemons that tick: 0: none; more than 1 is a mistake.")
      .def_property_readonly(
          "has_ended", [](Reports& self) { return self.use()->stream.has_ended(); },
          "There is no daemon any longer.")
      .def_property_readonly(
          "refusal", [](Reports& self) { return self.use()->stream.refusal(); },
          "Why an existing daemon cannot be heard, for a person; or empty.")
      .def_property_readonly(
          "refused",
          [](Reports& self) {
            const Reports::Use parts = self.use();
            return client::text_of(
                {parts->catalogue.refused(), parts->zones.refused(), parts->health.refused()});
          },
          "A sentence that counts the refused messages of catalogue, zones and health; empty if "
          "none "
          "was refused. A message is refused if it is not as the daemon wrote it.")
      .def_property_readonly("zones", &Reports::zones,
                             R"(The last known state of each zone: a dict of records by name.

Fields: zone (id), active, certified, cause, cause_object, pair, clearance, swept_clearance (m),
since_cycle, cycle, now_ns. Empty while none has come.)")
      .def_property_readonly(
          "health", &Reports::health,
          R"(The daemon's health, which comes once a second: a dict; None while none has come.

Keys are the fields of Health in idl/FIELDS.md, times in us and ns. rejected, inputs, joints, sources,
notes, shares and witnesses are lists of dicts.)");
  add_judgement(reports, [](Reports& self, const auto& act) {
    const Reports::Use parts = self.use();
    Judged all{*parts};
    return act(all);
  });
  reports.def_property_readonly(
      "is_held", [](Reports& self) { return Judged{*self.use()}.is_held(); },
      "Two reports were faulty within error_interval_s: `fail_safe` stays until acknowledge().");
  add_closing(reports);
}

}  // namespace clearance::python
