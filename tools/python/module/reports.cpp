// clearance.Reports and Report: monitor/client/client.hpp.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>
#include <utility>

#include "monitor/client/client.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/cell.hpp"
#include "tools/python/module/connection.hpp"
#include "tools/python/module/module.hpp"
#include "tools/python/module/tick_messages.hpp"

namespace clearance::python {
namespace {

using PairMessage = clearance_msg_PairDistance;

const py::dtype& pair_dtype() {
  // Never destroyed: the interpreter may be gone by then.
  static const auto* const dtype = new py::dtype(
      record_dtype({{"pair", "u4", offsetof(PairMessage, pair)},
                    {"part_a", "u4", offsetof(PairMessage, part_a)},
                    {"part_b", "u4", offsetof(PairMessage, part_b)},
                    {"status", "u1", offsetof(PairMessage, status)},
                    {"distance", "f8", offsetof(PairMessage, distance)},
                    {"lower", "f8", offsetof(PairMessage, lower)},
                    {"upper", "f8", offsetof(PairMessage, upper)},
                    {"swept_lower", "f8", offsetof(PairMessage, swept_lower)},
                    {"witness_a", "3f8", offsetof(PairMessage, witness_a)},
                    {"witness_b", "3f8", offsetof(PairMessage, witness_b)},
                    {"normal", "3f8", offsetof(PairMessage, normal)},
                    {"closing_speed", "f8", offsetof(PairMessage, closing_speed)},
                    {"time_to_contact", "f8", offsetof(PairMessage, time_to_contact)},
                    {"age_a_ns", "i8", offsetof(PairMessage, age_a_ns)},
                    {"age_b_ns", "i8", offsetof(PairMessage, age_b_ns)},
                    {"evaluated_cycle", "u8", offsetof(PairMessage, evaluated_cycle)},
                    {"refresh_age_cycles", "u8", offsetof(PairMessage, refresh_age_cycles)}},
                   sizeof(PairMessage)));
  return *dtype;
}

// The names of a scene's objects and pairs, made once for each revision.
struct Names {
  py::list pairs;          // all, two names each, by id
  py::list joints, zones;  // by id
  py::dict id_of;          // of a pair of names, in both orders
};

// A report, apart from the stream: it does not change.
struct Report {
  py::array pairs;
  PairMessage minimum;
  ReportCheck check;
  client::PartnerState partner;
  std::uint64_t daemon, cycle, revision;
  std::int64_t now_ns, publish_ns;
  double lower_all, swept_lower_all;
  bool minimum_known, minimum_certified;
  std::uint32_t pairs_total, evaluated, carried, stale, unknown;
  std::shared_ptr<const Names> names;  // null: the catalogue of its scene has not come
  py::object gradients = py::none(), drifts = py::none();  // arrays, or None
  py::object separated_zones = py::none(), separated_pairs = py::none();

  // The names of all zones or joints by id, or None.
  [[nodiscard]] py::object all_names(const py::list Names::*list) const {
    return names ? py::object((*names).*list) : py::none();
  }
  // The names of the pair, or None.
  [[nodiscard]] py::object names_of(std::uint32_t pair) const {
    if (!names || pair >= names->pairs.size()) return py::none();
    return names->pairs[pair];
  }
  [[nodiscard]] py::list pair_names() const {
    py::list list;
    const auto* rows = static_cast<const PairMessage*>(pairs.data());
    for (py::ssize_t i = 0; i < pairs.shape(0); ++i) list.append(names_of(rows[i].pair));
    return list;
  }
  // The record of a pair by two names.
  [[nodiscard]] py::object find(const py::tuple& pair) const {
    if (!names) throw py::key_error("the names of this report's scene have not come yet");
    if (!names->id_of.contains(pair))
      throw py::key_error(
          fmt::format("the daemon watches no pair {}", std::string(py::repr(pair))));
    const auto id = names->id_of[pair].cast<std::uint32_t>();
    const auto* rows = static_cast<const PairMessage*>(pairs.data());
    for (py::ssize_t i = 0; i < pairs.shape(0); ++i) {
      if (rows[i].pair == id) return pairs[py::int_(i)];
    }
    throw py::key_error(
        fmt::format("the pair {} is watched but not published; expected 'publish: true' "
                    "in its rule of the cell",
                    std::string(py::repr(pair))));
  }
};

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
  client::Catalogue catalogue;
  client::Zones zones;
  client::Health health;
  std::optional<TickMessages<clearance_msg_Gradients>> gradients;
  std::optional<TickMessages<clearance_msg_Separation>> separations;
  std::map<std::uint64_t, std::shared_ptr<const Names>> names;  // by revision
};

// The messages that belong to a report; null: not asked for, or they did not come.
struct Beside {
  const clearance_msg_Gradients* gradients = nullptr;
  const clearance_msg_Separation* separation = nullptr;
};

std::shared_ptr<const Names> names_of(ReportParts& parts, std::uint64_t revision) {
  if (const auto found = parts.names.find(revision); found != parts.names.end())
    return found->second;
  parts.catalogue.update();
  const clearance_msg_Catalogue* catalogue = parts.catalogue.message(revision);
  if (catalogue == nullptr) return nullptr;
  if (parts.names.size() >= client::Catalogue::kKept) parts.names.clear();
  auto names = std::make_shared<Names>();
  const auto name = [catalogue](std::uint32_t object) {
    return py::str(object < catalogue->objects._length ? catalogue->objects._buffer[object].name
                                                       : "");
  };
  for (std::uint32_t i = 0; i < catalogue->pairs._length; ++i) {
    const clearance_msg_CataloguePair& pair = catalogue->pairs._buffer[i];
    const py::str a = name(pair.object_a), b = name(pair.object_b);
    names->pairs.append(py::make_tuple(a, b));
    names->id_of[py::make_tuple(a, b)] = pair.id;
    names->id_of[py::make_tuple(b, a)] = pair.id;
  }
  for (std::uint32_t i = 0; i < catalogue->joints._length; ++i)
    names->joints.append(py::str(catalogue->joints._buffer[i].name));
  for (std::uint32_t i = 0; i < catalogue->zones._length; ++i)
    names->zones.append(py::str(catalogue->zones._buffer[i].name));
  parts.names[revision] = names;
  return names;
}

// Gradients need the number of joints, which comes with the names.
void add_beside(const Beside& beside, const clearance_msg_Distances& message, Report& report) {
  if (beside.gradients != nullptr && report.names) {
    std::vector<std::uint32_t> pairs;
    for (std::uint32_t i = 0; i < message.pairs._length; ++i)
      pairs.push_back(message.pairs._buffer[i].pair);
    GradientArrays arrays = gradient_arrays(*beside.gradients, pairs, report.names->joints.size());
    report.gradients = std::move(arrays.rates);
    report.drifts = std::move(arrays.drifts);
  }
  if (beside.separation != nullptr) {
    SeparationArrays arrays = separation_arrays(*beside.separation);
    report.separated_zones = std::move(arrays.zones);
    report.separated_pairs = std::move(arrays.pairs);
  }
}

Report report_of(ReportParts& parts, const Beside& beside) {
  const clearance_msg_Distances& message = *parts.stream;
  Report report = {.pairs = records_of(pair_dtype(), message.pairs._buffer, message.pairs._length),
                   .minimum = message.minimum,
                   .check = parts.stream.check(),
                   .partner = parts.stream.partner().state,
                   .daemon = message.daemon,
                   .cycle = message.cycle,
                   .revision = message.scene_revision,
                   .now_ns = message.now_ns,
                   .publish_ns = message.publish_ns,
                   .lower_all = message.lower_all,
                   .swept_lower_all = message.swept_lower_all,
                   .minimum_known = message.minimum_known,
                   .minimum_certified = message.minimum_certified,
                   .pairs_total = message.pairs_total,
                   .evaluated = message.evaluated,
                   .carried = message.carried,
                   .stale = message.stale,
                   .unknown = message.unknown,
                   .names = names_of(parts, message.scene_revision)};
  add_beside(beside, message, report);
  return report;
}

class Reports : public Live<ReportParts> {
 public:
  Reports(const SharedConnection& connection, double old_after_s, std::int32_t depth,
          bool gradients, bool separation)
      : Live("Reports", connection_of(connection), options(old_after_s, depth), gradients,
             separation) {}

  // None when the time is over.
  py::object wait(bool newest, const std::optional<double>& timeout_s) {
    const Use parts = use();
    bool came = false;
    Beside beside;
    {
      const Unlocked unlock;
      came = wait_in_slices(timeout_s, [&](std::chrono::nanoseconds slice) {
        return newest ? parts->stream.newest(slice) : parts->stream.next(slice);
      });
      const std::uint64_t daemon = parts->stream->daemon, cycle = parts->stream->cycle;
      if (came && parts->gradients) beside.gradients = parts->gradients->of(daemon, cycle);
      if (came && parts->separations) beside.separation = parts->separations->of(daemon, cycle);
    }
    return came ? py::cast(report_of(*parts, beside)) : py::none();
  }

  // States of zones of other daemons than that of the last report are left out, but for partners.
  py::dict zones() {
    const Use parts = use();
    const clearance_msg_Distances& last = *parts->stream;
    parts->zones.update();
    if (last.daemon != 0 && *last.partner == '\0') parts->zones.keep_only(last.daemon);
    if (last.cycle == 0) return zones_of(parts->zones, py::list());
    parts->zones.update(last);
    const auto names = names_of(*parts, last.scene_revision);
    return zones_of(parts->zones, names ? names->zones : py::list());
  }
  py::object health() {
    const Use parts = use();
    parts->health.update();
    const clearance_msg_Health* const message = parts->health.message();
    return message == nullptr ? py::object(py::none()) : health_of(*message);
  }

 private:
  static client::StreamOptions options(double old_after_s, std::int32_t depth) {
    if (!(old_after_s > 0.0 && old_after_s < 1e6))
      throw py::value_error("old_after_s: expected seconds above 0, at most 1e6");
    if (depth < 1 || depth > 100'000) throw py::value_error("depth: expected 1 to 100000 messages");
    return {.old_after = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * old_after_s)),
            .depth = depth};
  }
};

void add_report_class(py::module_& module) {
  py::class_<Report>(module, "Report", R"(The distances of one tick. It does not change.)")
      .def_readonly("pairs", &Report::pairs, R"(Records of the published pairs.

Fields: pair (id), part_a, part_b, status (PairStatus), distance, lower, upper, swept_lower, witness_a,
witness_b, normal, closing_speed, time_to_contact, age_a_ns, age_b_ns, evaluated_cycle and
refresh_age_cycles. m, m/s, s, ns, in the world. idl/FIELDS.md explains each.)")
      .def_property_readonly(
          "pair_names", &Report::pair_names,
          "Two names for each record of `pairs`; None while names have not come.")
      .def("__getitem__", &Report::find, py::arg("pair"),
           R"(The record of a published pair by two names, in any order. Raises KeyError.)")
      .def_property_readonly(
          "minimum",
          [](const Report& r) {
            const py::array record = records_of(pair_dtype(), &r.minimum, 1);
            return py::object(record[py::int_(0)]);
          },
          "The record of the pair with the smallest upper bound; see minimum_known.")
      .def_property_readonly(
          "minimum_names",
          [](const Report& r) { return r.minimum_known ? r.names_of(r.minimum.pair) : py::none(); },
          "Its two names, or None.")
      .def_readonly(
          "gradients", &Report::gradients,
          R"((pairs, joints): how each distance of `pairs` changes with each of `joints`, m/rad or m/m.

0: the joint does not move the pair. NaN: not known, or no joint moves the pair. None: not asked for
(Reports(gradients=True)), not published (`gradients: true` in the cell), or names have not come.)")
      .def_readonly(
          "drifts", &Report::drifts,
          R"((pairs,): the rate of change if all joints stood still, m/s; None like `gradients`.)")
      .def_readonly(
          "separated_zones", &Report::separated_zones,
          R"(Records of the zones with `separation`: zone (id), validity, pair, remaining (m),
speed_limit (m/s), scaling (0 to 1).

None: not asked for (Reports(separation=True)), or the cell has no such zone.)")
      .def_readonly(
          "separated_pairs", &Report::separated_pairs,
          R"(Records of their pairs: zone, pair, validity, clearance, human_speed, robot_speed,
human_term, robot_term, stopping_term, protective_distance, remaining, speed_limit, scaling,
age_human_ns, age_robot_ns. m, m/s, ns, as in ISO/TS 15066; None like `separated_zones`.)")
      .def_property_readonly(
          "joints", [](const Report& r) { return r.all_names(&Names::joints); },
          "Names of the columns of `gradients`; None while names have not come.")
      .def_property_readonly(
          "zone_names", [](const Report& r) { return r.all_names(&Names::zones); },
          "Names of all zones by id; None while names have not come.")
      .def_readonly("minimum_known", &Report::minimum_known, "False: no pair is known.")
      .def_readonly("minimum_certified", &Report::minimum_certified, "No other pair can be closer.")
      .def_readonly("lower_all", &Report::lower_all, "Certified: no pair is closer, m.")
      .def_readonly("swept_lower_all", &Report::swept_lower_all,
                    "The same at every instant since the last tick.")
      .def_property_readonly(
          "fresh", [](const Report& r) { return r.check.fresh(); }, "It describes the present.")
      .def_property_readonly(
          "age_s", [](const Report& r) { return 1e-9 * static_cast<double>(r.check.age_ns); },
          "Since it was published, s, when it was taken.")
      .def_property_readonly(
          "missed", [](const Report& r) { return r.check.missed; },
          "Reports between the one before and this one.")
      .def_property_readonly(
          "other_daemon", [](const Report& r) { return r.check.other_daemon; },
          "The report before is of another run of a daemon.")
      .def_property_readonly(
          "partner", [](const Report& r) { return client::name(r.partner); },
          "Of two partners, whose reports are merged: 'alone', 'agrees', 'missing', 'other "
          "inputs', "
          "'different' or 'corrupt'.")
      .def_property_readonly(
          "other_scene", [](const Report& r) { return r.check.other_scene; },
          "The report before is of another scene, with other ids.")
      .def_readonly("daemon", &Report::daemon, "Which run of which daemon: random.")
      .def_readonly("cycle", &Report::cycle, "Counts ticks from 1.")
      .def_readonly("revision", &Report::revision, "Of the scene.")
      .def_readonly("now_ns", &Report::now_ns, "The time of the tick.")
      .def_readonly("publish_ns", &Report::publish_ns, "CLOCK_REALTIME when it was published.")
      .def_readonly("pairs_total", &Report::pairs_total, "Watched pairs.")
      .def_readonly("evaluated", &Report::evaluated, "Pairs that were evaluated in this tick.")
      .def_readonly("carried", &Report::carried, "Pairs with carried bounds.")
      .def_readonly("stale", &Report::stale, "Pairs with a late pose.")
      .def_readonly("unknown", &Report::unknown, "Pairs without a pose.")
      .def("__repr__", [](const Report& r) {
        return fmt::format("<clearance.Report: cycle {}, {} pairs, minimum {} m{}>", r.cycle,
                           r.pairs.shape(0), r.minimum_known ? r.minimum.distance : r.lower_all,
                           r.check.fresh() ? "" : ", not fresh");
      });
}

}  // namespace

void add_reports(py::module_& module) {
  py::register_exception<DdsError>(module, "DdsError", PyExc_RuntimeError).doc() =
      "DDS refused something: the text says what was attempted, where, and the reason.";
  py::register_exception<ClosedError>(module, "ClosedError", PyExc_RuntimeError).doc() =
      "The object was closed.";
  add_connection(module);
  add_report_class(module);
  py::class_<Reports> reports(module, "Reports", R"(The reports of a running daemon.

Iterating waits for each in order, without an end. One thread uses it at a time. Waits release the
interpreter's lock, and Ctrl-C ends them.)");
  reports
      .def(
          py::init<const SharedConnection&, double, std::int32_t, bool, bool>(),
          py::arg("connection") = py::none(), py::kw_only(), py::arg("old_after_s") = 0.1,
          py::arg("depth") = 64, py::arg("gradients") = false, py::arg("separation") = false,
          R"(connection: None: loopback, domain 0, the default partition. old_after_s: an older report
is not fresh, s. depth: messages that may wait. gradients, separation: reports have these of their tick,
where the cell asks for them. Raises ValueError and DdsError.)")
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
      .def_property_readonly("zones", &Reports::zones,
                             R"(The last known state of each zone: a dict of records by name.

Fields: zone (id), active, certified, cause, cause_object, pair, clearance, swept_clearance (m),
since_cycle, cycle, now_ns. Empty while none has come.)")
      .def_property_readonly(
          "health", &Reports::health,
          R"(The daemon's health, which comes once a second: a dict; None while none has come.

Keys are the fields of Health in idl/FIELDS.md, times in us and ns. rejected, inputs, joints, sources
and notes are lists of dicts.)");
  add_closing(reports);
}

}  // namespace clearance::python
