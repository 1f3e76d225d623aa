#include "tools/python/module/module.hpp"

PYBIND11_MODULE(_clearance, module) {
  using namespace clearance::python;
  module.doc() = "Clearance in C++. Import clearance instead, which has the same names.";
  pybind11::options options;
  options.disable_enum_members_docstring();
  add_bodies(module);
  add_distance(module);
  add_batch(module);
  add_cell(module);
  add_replay(module);
  add_reports(module);
  add_writers(module);
  add_commands(module);
}
