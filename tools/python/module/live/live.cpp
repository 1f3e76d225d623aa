#include "tools/python/module/live/live.hpp"

#include "tools/python/module/live/connection.hpp"
#include "tools/python/module/module.hpp"

namespace clearance::python {

void add_live(py::module_& module) {
  py::register_exception<DdsError>(module, "DdsError", PyExc_RuntimeError).doc() =
      "DDS refused something: the text says what was attempted, where, and the reason.";
  py::register_exception<ClosedError>(module, "ClosedError", PyExc_RuntimeError).doc() =
      "The object was closed.";
  add_connection(module);
  add_report_class(module);
  add_reports(module);
  add_shared_cell(module);
  add_writers(module);
  add_commands(module);
  add_live_questions(module);
}

}  // namespace clearance::python
