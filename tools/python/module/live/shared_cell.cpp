// clearance.SharedCell: monitor/client/shared_cell.hpp.
#include "monitor/client/shared_cell.hpp"

#include <pybind11/stl.h>
#include <optional>

#include <algorithm>
#include <set>
#include <utility>

#include "config/cell/shares.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/live/connection.hpp"
#include "tools/python/module/live/live.hpp"
#include "tools/python/module/live/report.hpp"
#include "tools/python/module/live/tick_messages.hpp"

namespace clearance::python {
namespace {

using client::ShareState;

// The type is never destroyed: the interpreter may be gone by then.
py::object& state_enum() {
  static auto* const type = new py::object();
  return *type;
}

struct SharedParts {
  SharedParts(SharedConnection joined, client::SharedCellOptions options)
      : connection(std::move(joined)), whole(*connection, std::move(options)) {}

  SharedConnection connection;
  client::SharedCell whole;
  KnownNames names;
};

py::dict dict_of(const client::ShareCheck& check) {
  py::dict share;
  share["state"] = state_enum()(static_cast<int>(check.state));
  share["daemon"] = check.daemon;
  share["cycle"] = check.cycle;
  share["revision"] = check.scene_revision;
  share["age_s"] = check.cycle == 0 ? py::object(py::none())
                                    : py::float_(1e-9 * static_cast<double>(check.age_ns));
  share["partner"] = client::name(check.partner.state);
  return share;
}

class SharedCell : public Live<SharedParts> {
 public:
  SharedCell(const SharedConnection& connection, const std::optional<double>& late_after_s,
             double old_after_s, bool gradients, std::vector<std::string> names)
      : Live("SharedCell", connection_of(connection),
             options(late_after_s, old_after_s, gradients, std::move(names))) {}

  // None when the time is over.
  py::object wait(bool newest, const std::optional<double>& timeout_s) {
    const Use parts = use();
    client::SharedCell& whole = parts->whole;
    bool came = false;
    {
      const Unlocked unlock;
      came = wait_in_slices(timeout_s, [&](std::chrono::nanoseconds slice) {
        return newest ? whole.newest(slice) : whole.next(slice);
      });
    }
    if (!came) return py::none();
    client::PartnerCheck partner;
    for (const client::ShareCheck& check : whole.shares())
      partner = client::worse(partner, check.partner);
    return py::cast(report_of(*whole, whole.check(), partner.state,
                              parts->names.of(whole->scene_revision, whole.catalogue()),
                              {.gradients = whole.gradients(), .separation = whole.separation()}));
  }
  py::dict shares() {
    const Use parts = use();
    py::dict all;
    for (const client::ShareCheck& check : parts->whole.shares())
      all[py::str(check.name)] = dict_of(check);
    return all;
  }
  py::object health() {
    const Use parts = use();
    if (parts->whole->cycle == 0) return py::none();
    return health_of(*parts->whole.health());
  }

 private:
  static client::SharedCellOptions options(const std::optional<double>& late_after_s,
                                           double old_after_s, bool gradients,
                                           std::vector<std::string> names) {
    const auto fits = [](const std::string& name) {
      return !name.empty() && name.size() <= kMaxShareName;
    };
    const bool differ = std::set<std::string>(names.begin(), names.end()).size() == names.size();
    if (!differ || names.size() > kMaxShares || !std::ranges::all_of(names, fits))
      throw py::value_error("names: expected at most 64 different names of 1 to 32 bytes");
    std::optional<std::chrono::nanoseconds> late_after;
    if (late_after_s) late_after = seconds_of(*late_after_s, "late_after_s");
    return {.late_after = late_after,
            .old_after = seconds_of(old_after_s, "old_after_s"),
            .gradients = gradients,
            .names = std::move(names)};
  }
};

}  // namespace

void add_shared_cell(py::module_& module) {
  std::vector<Enumerator> states;
  for (int value = 0; value <= static_cast<int>(ShareState::kHeld); ++value)
    states.push_back({constant_name(client::name(static_cast<ShareState>(value))), value});
  state_enum() = add_enum(module, "ShareState", states,
                          "Whether the reports of a share are used, and why not (SHARES.md).");
  py::class_<SharedCell> shared(module, "SharedCell", R"(A cell in shares: its daemons as one.

One report, one state of each zone and one health for the whole cell. Whatever hangs on a share that is
not whole is unknown, its zones are active, and what_is_missing names it. Partners of a share are merged.

Iterating waits for each report in order, without an end. One thread uses it at a time. Waits release
the interpreter's lock, and Ctrl-C ends them.)");
  shared
      .def(
          py::init<const SharedConnection&, const std::optional<double>&, double, bool,
                   std::vector<std::string>>(),
          py::arg("connection") = py::none(), py::kw_only(), py::arg("late_after_s") = py::none(),
          py::arg("old_after_s") = 0.1, py::arg("gradients") = false,
          py::arg("names") = std::vector<std::string>(),
          R"(connection: None: one without arguments, on this machine's loopback. late_after_s: what hangs on a
share whose last report is older is unknown, s; at least two periods. None: three periods of the
cell, and at least 0.02 s. old_after_s: an older report is
not fresh, s. gradients: reports have these of the shares, where the cell asks for them. names: of the
shares; without any, they are those of the first share that is met. Raises ValueError and DdsError.)")
      .def(
          "next",
          [](SharedCell& self, const std::optional<double>& timeout) {
            return self.wait(false, timeout_of(timeout));
          },
          py::arg("timeout") = py::none(),
          R"(The next report of the whole cell; None if none came within `timeout` s (None: no end).

There is one each time that every share has reported again, or that one has reported twice.)")
      .def(
          "newest",
          [](SharedCell& self, const std::optional<double>& timeout) {
            return self.wait(true, timeout_of(timeout));
          },
          py::arg("timeout") = py::none(),
          "The newest report, for a controller; waits like next() if none waits.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", [](SharedCell& self) { return self.wait(false, std::nullopt); })
      .def_property_readonly(
          "is_whole", [](SharedCell& self) { return self.use()->whole.is_whole(); },
          "The last report rests on all shares.")
      .def_property_readonly(
          "what_is_missing", [](SharedCell& self) { return self.use()->whole.what_is_missing(); },
          "For a person: \"the share 'left' is missing, ...\"; empty if the cell is whole.")
      .def_property_readonly("shares", &SharedCell::shares,
                             R"(The shares as in the last report: a dict of dicts by name.

Keys: state (ShareState), daemon, cycle, revision, age_s (since its last report; None: none has come),
partner (as Report.partner).)")
      .def_property_readonly(
          "missed", [](SharedCell& self) { return self.use()->whole.missed(); },
          "Reports of shares that did not come, since the beginning.")
      .def_property_readonly(
          "zones", [](SharedCell& self) { return zones_of(self.use()->whole.zones(), py::list()); },
          R"(The state of each zone, as of the last report: a dict of records by name.

Fields as Reports.zones. A zone with pairs of a share that is not whole is active, with cause 8.)")
      .def_property_readonly("health", &SharedCell::health,
                             R"(The health of all daemons: a dict; None before the first report.

Keys as Reports.health: counts are sums, times and ages the largest. shares has the state of each.)");
  add_judgement(shared, [](SharedCell& self, const auto& act) {
    const SharedCell::Use parts = self.use();
    return act(parts->whole);
  });
  add_closing(shared);
}

}  // namespace clearance::python
