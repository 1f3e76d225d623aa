// The parts of the Python module. Each adds its classes and functions.
#pragma once

#include <pybind11/pybind11.h>

namespace clearance::python {

void add_bodies(pybind11::module_& module);
void add_distance(pybind11::module_& module);
void add_batch(pybind11::module_& module);
void add_cell(pybind11::module_& module);
void add_replay(pybind11::module_& module);
void add_answers(pybind11::module_& module);
// Adds the classes that talk over DDS, if CLEARANCE_PYTHON_DDS is on.
void add_live(pybind11::module_& module);

}  // namespace clearance::python
