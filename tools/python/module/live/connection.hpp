// clearance.Connection, and what all live objects share: closing, and one thread at a time.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {

using SharedConnection = std::shared_ptr<client::Connection>;

// The argument `connection` of a live object: a Connection, or None, which makes one with the
// defaults.
[[nodiscard]] SharedConnection connection_of(const SharedConnection& given);

class ClosedError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// An object on DDS that close() ends. Using it afterwards is an exception, and so is using it in
// two threads at once.
template <class T>
class Live {
 public:
  // The parts in use, and the proof that no other thread uses them.
  class Use {
   public:
    Use(std::atomic<bool>& in_use, const char* what, T* parts)
        : exclusive_(in_use, what), parts_(*parts) {}
    T* operator->() const noexcept { return &parts_; }
    T& operator*() const noexcept { return parts_; }

   private:
    Exclusive exclusive_;
    T& parts_;
  };

  template <class... Arguments>
  explicit Live(const char* what, Arguments&&... arguments)
      : what_(what), parts_(std::make_unique<T>(std::forward<Arguments>(arguments)...)) {}

  [[nodiscard]] Use use() {
    if (!parts_) throw ClosedError(std::string(what_) + " is closed");
    return Use(in_use_, what_, parts_.get());
  }
  void close() {
    const Exclusive exclusive(in_use_, what_);
    parts_.reset();
  }
  [[nodiscard]] bool closed() const noexcept { return !parts_; }

 private:
  const char* what_;
  std::atomic<bool> in_use_ = false;
  std::unique_ptr<T> parts_;
};

// Adds close(), closed and the methods of a `with` statement.
template <class Class>
void add_closing(Class& type) {
  using T = typename Class::type;
  namespace py = pybind11;
  type.def(
          "close", [](T& self) { self.close(); },
          "Leaves DDS. Any other use is a ClosedError afterwards.")
      .def_property_readonly(
          "closed", [](const T& self) { return self.closed(); }, "True after close().")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](T& self, const py::args&) { self.close(); });
}

}  // namespace clearance::python
