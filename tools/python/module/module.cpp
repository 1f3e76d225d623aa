#include "tools/python/module/module.hpp"

#include <exception>
#include <utility>

#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

namespace py = pybind11;

PyTypeObject* base_type() {
  return reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
}

newfunc make_with_memory = nullptr;  // pybind11's own

// pybind11 throws where the class is none of its own, as in copyreg's call of the common base. An
// exception of C++ that passed through Python would end the interpreter.
PyObject* make_without_throwing(PyTypeObject* type, PyObject* arguments, PyObject* keywords) {
  try {
    return make_with_memory(type, arguments, keywords);
  } catch (const std::exception&) {
    PyErr_Format(PyExc_TypeError, "cannot make, copy or pickle an object by '%s'", type->tp_name);
    return nullptr;
  }
}

void refuse_the_common_base() {
  if (base_type()->tp_new == make_without_throwing) return;
  make_with_memory = std::exchange(base_type()->tp_new, make_without_throwing);
  PyType_Modified(base_type());
}

PyObject* make(PyTypeObject* type, PyObject* arguments, PyObject* keywords) {
  return base_type()->tp_new(type, arguments, keywords);
}

// pybind11 gives the methods of an object whose __init__ was not called memory that nothing has
// filled. Body.__new__(Body) is the only call that makes such an object. Python refuses that call,
// by itself, where a class makes its objects otherwise than its base does.
void refuse_new_without_init(const py::module_& module) {
  for (const auto& [name, value] : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(value.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(value.ptr());
    if (PyType_IsSubtype(type, base_type()) == 0) continue;
    type->tp_new = make;
    PyType_Modified(type);
  }
}

}  // namespace
}  // namespace clearance::python

PYBIND11_MODULE(_clearance, module) {
  using namespace clearance::python;
  module.doc() = "Clearance in C++. Import clearance instead, which has the same names.";
  module.attr("__version__") = CLEARANCE_VERSION;
  watch_for_the_end();
  add_bodies(module);
  add_distance(module);
  add_batch(module);
  add_cell(module);
  add_replay(module);
#ifdef CLEARANCE_PYTHON_DDS
  add_live(module);
#endif
  refuse_the_common_base();
  refuse_new_without_init(module);
}
