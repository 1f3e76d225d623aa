// The parts of the Python module. Each adds its classes and functions.
#pragma once

#include <pybind11/pybind11.h>

namespace clearance::python {

void add_bodies(pybind11::module_& module);
void add_distance(pybind11::module_& module);
void add_batch(pybind11::module_& module);
void add_cell(pybind11::module_& module);
void add_replay(pybind11::module_& module);
void add_reports(pybind11::module_& module);
void add_shared_cell(pybind11::module_& module);
void add_writers(pybind11::module_& module);
void add_commands(pybind11::module_& module);
void add_answers(pybind11::module_& module);

}  // namespace clearance::python
