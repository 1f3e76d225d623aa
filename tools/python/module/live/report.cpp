#include "tools/python/module/live/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/python/module/arrays.hpp"
#include "tools/python/module/live/fields.hpp"
#include "tools/python/module/live/live.hpp"
#include "tools/python/module/live/tick_messages.hpp"

namespace clearance::python {
namespace {

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
    report.separated_zones = value_of(beside.separation->zones);
    report.separated_pairs = value_of(beside.separation->pairs);
    report.stops = value_of(beside.separation->stops);
  }
}

}  // namespace

std::shared_ptr<const Names> KnownNames::of(std::uint64_t revision) const {
  const auto found = by_revision_.find(revision);
  return found == by_revision_.end() ? nullptr : found->second;
}

std::shared_ptr<const Names> KnownNames::of(std::uint64_t revision,
                                            const clearance_msg_Catalogue* catalogue) {
  if (auto known = of(revision); known || catalogue == nullptr) return known;
  if (by_revision_.size() >= client::Catalogue::kKept) by_revision_.clear();
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
  by_revision_[revision] = names;
  return names;
}

py::object Report::names_of(std::uint32_t pair) const {
  if (!names || pair >= names->pairs.size()) return py::none();
  return names->pairs[pair];
}

py::list Report::pair_names() const {
  py::list list;
  for (const py::handle pair : field("pairs")["pair"])
    list.append(names_of(pair.cast<std::uint32_t>()));
  return list;
}

py::object Report::minimum_names() const {
  if (!field("minimum_known").cast<bool>()) return py::none();
  return names_of(field("minimum")["pair"].cast<std::uint32_t>());
}

py::object Report::find(const py::tuple& pair) const {
  if (!names) throw py::key_error("the names of this report's scene have not come yet");
  if (!names->id_of.contains(pair))
    throw py::key_error(fmt::format("the daemon watches no pair {}", std::string(py::repr(pair))));
  const auto id = names->id_of[pair].cast<std::uint32_t>();
  for (const py::handle row : field("pairs")) {
    if (row["pair"].cast<std::uint32_t>() == id) return py::reinterpret_borrow<py::object>(row);
  }
  throw py::key_error(
      fmt::format("the pair {} is watched but not published; expected 'publish: true' "
                  "in its rule of the cell",
                  std::string(py::repr(pair))));
}

Report report_of(const clearance_msg_Distances& message, const ReportCheck& check,
                 client::PartnerState partner, std::shared_ptr<const Names> names,
                 const Beside& beside) {
  Report report = {
      .fields = fields_of(message), .check = check, .partner = partner, .names = std::move(names)};
  add_beside(beside, message, report);
  return report;
}

namespace {

// The meanings of fields for readers in Python. idl/FIELDS.md explains those that are not in
// it.
struct FieldText {
  std::string_view field;
  const char* text;
};
constexpr FieldText kTexts[] = {
    {"pairs", R"(Records of the published pairs.

Fields: pair (id), part_a, part_b, status (PairStatus), distance, lower, upper, swept_lower, model_error, stop_lower,
witness_a, witness_b, normal, closing_speed, time_to_contact, age_a_ns, age_b_ns, evaluated_cycle and
refresh_age_cycles. m, m/s, s, ns, in the world. idl/FIELDS.md explains each.)"},
    {"minimum", "The record of the pair with the smallest upper bound; see minimum_known."},
    {"contacts",
     "Records of the contacts that the cell allows: pair, status, ended, depth (m) and since."},
    {"hidden",
     "Records of published pairs of a sensor and a link: what own image and blind shells hide "
     "there."},
    {"active_zones", "Ids of the zones that are active in this tick, ascending."},
    {"sources",
     "Dicts with the source and sequence_number of every batch that this tick used first."},
    {"minimum_known", "False: no pair is known."},
    {"minimum_certified", "No other pair can be closer."},
    {"lower_all", "Certified: no pair is closer, m."},
    {"swept_lower_all", "The same at every instant since the last tick."},
    {"daemon", "A random number that names one run of one daemon."},
    {"cycle", "Counts ticks from 1."},
    {"scene_revision", "Of the scene."},
    {"now_ns", "The time of the tick."},
    {"publish_ns", "CLOCK_REALTIME when it was published."},
    {"pairs_total", "Watched pairs."},
    {"evaluated", "Pairs that were evaluated in this tick."},
    {"carried", "Pairs with carried bounds."},
    {"stale", "Pairs with a late pose."},
    {"unknown", "Pairs without a pose."}};

// All fields of the message but `partner`, which is what partners' reports merged say.
void add_fields(py::class_<Report>& type) {
  const auto add = [&type](const clearance::Field& field, const auto&) {
    if (field.name == "partner") return;
    const auto known = std::ranges::find(kTexts, field.name, &FieldText::field);
    const std::string name(field.name);
    type.def_property_readonly(
        name.c_str(), [name](const Report& report) { return report.field(name.c_str()); },
        known != std::end(kTexts) ? known->text : "idl/FIELDS.md explains it.");
  };
  const clearance_msg_Distances message{};
  for_each_field(add, message);
}

void add_records(py::class_<Report>& type) {
  type.def_property_readonly("pair_names", &Report::pair_names,
                             "Two names for each record of `pairs`.")
      .def("__getitem__", &Report::find, py::arg("pair"),
           R"(The record of a published pair by two names, in any order. Raises KeyError.)")
      .def_property_readonly("minimum_names", &Report::minimum_names, "Its two names, or None.")
      .def_readonly(
          "gradients", &Report::gradients,
          R"((pairs, joints): how each distance of `pairs` changes with each of `joints`, m/rad or m/m.

0: the joint does not move the pair. NaN: not known, or no joint moves the pair. None: not asked for
(Reports(gradients=True)), or not published (`gradients: true` in the cell).)")
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
      .def_readonly(
          "stops", &Report::stops,
          R"(Records of the robots with `stopping`: robot (id), validity, scaling (0 to 1), clearance (m),
pair, share (0 to 1), time (s). None like `separated_zones`.)")
      .def_property_readonly(
          "joints", [](const Report& r) { return r.all_names(&Names::joints); },
          "Names of the columns of `gradients`.")
      .def_property_readonly(
          "zone_names", [](const Report& r) { return r.all_names(&Names::zones); },
          "Names of all zones by id.");
}

void add_figures(py::class_<Report>& type) {
  type.def_property_readonly(
          "fresh", [](const Report& r) { return r.check.fresh(); }, "It describes the present.")
      .def_property_readonly(
          "age_s", [](const Report& r) { return 1e-9 * static_cast<double>(r.check.age_ns); },
          "Since it was published, s, when it was taken.")
      .def_property_readonly(
          "missed", [](const Report& r) { return r.check.missed; },
          "Reports between the one before and this one.")
      .def_property_readonly(
          "error", [](const Report& r) { return error_of(r.check.error); },
          "Why it must not be relied on (ReportError); GOOD: it is good.")
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
      .def_property_readonly(
          "revision", [](const Report& r) { return r.field("scene_revision"); }, "Of the scene.")
      .def("__repr__", [](const Report& r) {
        const auto number = [&r](const char* name) { return r.field(name).cast<double>(); };
        const bool is_known = r.field("minimum_known").cast<bool>();
        return fmt::format(
            "<clearance.Report: cycle {:.0f}, {} pairs, minimum {} m{}>", number("cycle"),
            py::len(r.field("pairs")),
            is_known ? r.field("minimum")["distance"].cast<double>() : number("lower_all"),
            r.check.fresh() ? "" : ", not fresh");
      });
}

}  // namespace

// The type is never destroyed: the interpreter may be gone by then.
py::object& error_enum() {
  static auto* const type = new py::object();
  return *type;
}

py::object error_of(ReportError error) { return error_enum()(static_cast<int>(error)); }

void add_report_class(py::module_& module) {
  std::vector<Enumerator> errors;
  for (int value = 0; value <= static_cast<int>(ReportError::kShare); ++value)
    errors.push_back({constant_name(client::name(static_cast<ReportError>(value))), value});
  error_enum() = add_enum(module, "ReportError", errors,
                          "Why a report must not be relied on, or no report may (END_TO_END.md).");
  py::class_<Report> type(module, "Report", R"(The distances of one tick. It does not change.)");
  add_fields(type);
  add_records(type);
  add_figures(type);
}

}  // namespace clearance::python
