#include "tools/python/module/waiting.hpp"

#include <unistd.h>

namespace clearance::python {
namespace {

std::atomic<bool> ending = false;
std::atomic<unsigned long> main_thread = 0;
std::atomic<int> locking = 0;  // threads that take the interpreter's lock again

// Called by the main thread when Python ends. Threads that wait for the lock get it before.
void leave_in_peace() {
  ending = true;
  const py::gil_scoped_release unlocked;
  while (locking != 0) usleep(100);
}

}  // namespace

bool is_ending() noexcept { return ending; }

bool is_main_thread() noexcept { return PyThread_get_thread_ident() == main_thread; }

// Either this sees that the program ends, or leave_in_peace() sees that this thread takes the lock.
void Unlocked::lock_again(PyThreadState* state) noexcept {
  ++locking;
  if (is_ending() && !is_main_thread()) {
    --locking;
    for (;;) pause();
  }
  PyEval_RestoreThread(state);
  --locking;
}

void watch_for_the_end() {
  const py::object main = py::module_::import("threading").attr("main_thread")();
  main_thread = main.attr("ident").cast<unsigned long>();
  py::module_::import("atexit").attr("register")(py::cpp_function(leave_in_peace));
}

}  // namespace clearance::python
