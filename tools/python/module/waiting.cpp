#include "tools/python/module/waiting.hpp"

#include <unistd.h>

namespace clearance::python {
namespace {

std::atomic<bool> ending = false;
std::atomic<unsigned long> main_thread = 0;

}  // namespace

bool is_ending() noexcept { return ending; }

bool is_main_thread() noexcept { return PyThread_get_thread_ident() == main_thread; }

void Unlocked::stay() noexcept {
  for (;;) pause();
}

void watch_for_the_end() {
  const py::object main = py::module_::import("threading").attr("main_thread")();
  main_thread = main.attr("ident").cast<unsigned long>();
  py::module_::import("atexit").attr("register")(py::cpp_function([] { ending = true; }));
}

}  // namespace clearance::python
