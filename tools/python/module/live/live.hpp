// The parts of the Python module that talk over DDS. Each adds its classes.
#pragma once

#include <pybind11/pybind11.h>

namespace clearance::python {

void add_connection(pybind11::module_& module);
void add_report_class(pybind11::module_& module);
void add_reports(pybind11::module_& module);
void add_shared_cell(pybind11::module_& module);
void add_writers(pybind11::module_& module);
void add_commands(pybind11::module_& module);
void add_live_questions(pybind11::module_& module);

}  // namespace clearance::python
