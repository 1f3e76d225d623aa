// clearance.Report: the distances of one tick, of a daemon or of a whole cell in shares.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <memory>

#include "monitor/client/client.hpp"

namespace clearance::python {

namespace py = pybind11;

// The names of a scene's objects and pairs, made once for each revision.
struct Names {
  py::list pairs;          // all, two names each, by id
  py::list joints, zones;  // by id
  py::dict id_of;          // of a pair of names, in both orders
};

// Keeps the names of the last scenes.
class KnownNames {
 public:
  // `catalogue` is that of this revision; null: it has not come, and neither have the names.
  std::shared_ptr<const Names> of(std::uint64_t revision, const clearance_msg_Catalogue* catalogue);
  // Null: they are not known.
  [[nodiscard]] std::shared_ptr<const Names> of(std::uint64_t revision) const;

 private:
  std::map<std::uint64_t, std::shared_ptr<const Names>> by_revision_;
};

// The messages that belong to a report; null: not asked for, or they did not come.
struct Beside {
  const clearance_msg_Gradients* gradients = nullptr;
  const clearance_msg_Separation* separation = nullptr;
};

// A copy of a report: it does not change when the stream goes on.
struct Report {
  py::dict fields;  // of the message by their names; `partner` is the one below
  ReportCheck check;
  client::PartnerState partner;
  std::shared_ptr<const Names> names;  // null: the catalogue of its scene has not come
  py::object gradients = py::none(), drifts = py::none();  // arrays, or None
  py::object separated_zones = py::none(), separated_pairs = py::none(), stops = py::none();

  // The names of all zones or joints by id, or None.
  [[nodiscard]] py::object all_names(const py::list Names::*list) const {
    return names ? py::object((*names).*list) : py::none();
  }
  // The names of the pair, or None.
  [[nodiscard]] py::object names_of(std::uint32_t pair) const;
  [[nodiscard]] py::list pair_names() const;
  [[nodiscard]] py::object minimum_names() const;
  [[nodiscard]] py::object field(const char* name) const { return fields[name]; }
  // The record of a pair by two names.
  [[nodiscard]] py::object find(const py::tuple& pair) const;
};

// `names` may be null.
[[nodiscard]] Report report_of(const clearance_msg_Distances& message, const ReportCheck& check,
                               client::PartnerState partner, std::shared_ptr<const Names> names,
                               const Beside& beside);

// The Python value of ReportError.
[[nodiscard]] py::object error_of(ReportError error);

// Defines what says whether reports may be relied on. `with` calls a function with the stream of an
// object, which no other thread uses meanwhile.
template <class Class, class With>
void add_judgement(Class& type, const With& with) {
  using T = typename Class::type;
  type.def_property_readonly(
          "fail_safe",
          [with](T& self) { return with(self, [](auto& stream) { return stream.fail_safe(); }); },
          "No report may be relied on now, as `reason` says; time counts since the last good one.")
      .def_property_readonly(
          "reason",
          [with](T& self) {
            return error_of(with(self, [](auto& stream) { return stream.reason(); }));
          },
          "Why (ReportError); GOOD: the last good report counts.")
      .def(
          "acknowledge",
          [with](T& self) { with(self, [](auto& stream) { stream.acknowledge(); }); },
          "Ends a hold: a person has looked at the faults. The next good report counts again.");
}

}  // namespace clearance::python
