#include "tools/python/module/module.hpp"

#include "tools/python/module/waiting.hpp"

PYBIND11_MODULE(_clearance, module) {
  using namespace clearance::python;
  module.doc() = "Clearance in C++. Import clearance instead, which has the same names.";
  watch_for_the_end();
  add_bodies(module);
  add_distance(module);
  add_batch(module);
  add_cell(module);
  add_replay(module);
  add_reports(module);
  add_writers(module);
  add_commands(module);
}
