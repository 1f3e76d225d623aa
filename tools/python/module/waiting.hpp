// Waiting and long computations without the interpreter's lock, which Ctrl-C can end.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

namespace clearance::python {

namespace py = pybind11;

// Signals are looked for this often.
inline constexpr std::chrono::milliseconds kSlice{50};

// Tells whether the program is leaving Python, and whether this is Python's main thread, the only
// one that gets signals. Both need no lock.
[[nodiscard]] bool is_ending() noexcept;
[[nodiscard]] bool is_main_thread() noexcept;
// To be called once, when the module is made.
void watch_for_the_end();

// Releases the interpreter's lock for a scope. A thread that would take it again while the program
// ends stays here instead: Python would end it by unwinding, which C++ answers with an abort.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked() { lock_again(state_); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  static void lock_again(PyThreadState* state) noexcept;

  PyThreadState* state_;
};

// True if a signal is pending; its exception is set. Called without the interpreter's lock.
[[nodiscard]] inline bool interrupted() {
  if (!is_main_thread()) return false;
  const py::gil_scoped_acquire lock;
  return PyErr_CheckSignals() != 0;
}

// Throws the exception of a pending signal: KeyboardInterrupt. Called without the interpreter's
// lock.
inline void check_signals() {
  if (!is_main_thread()) return;
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Seconds to wait; None: without an end. Throws ValueError.
inline std::optional<double> timeout_of(const std::optional<double>& seconds) {
  if (!seconds) return std::nullopt;
  if (!(*seconds >= 0.0)) throw py::value_error("timeout: expected seconds, at least 0, or None");
  return std::min(*seconds, 1e9);
}

// An argument in seconds as nanoseconds. Throws ValueError.
inline std::chrono::nanoseconds seconds_of(double value, const char* name) {
  if (!(value > 0.0 && value < 1e6))
    throw py::value_error(std::string(name) + ": expected seconds above 0, at most 1e6");
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * value));
}

// Calls `attempt` with the time that it may wait, until it returns true or the time is over. Must
// be called without the interpreter's lock.
template <class Attempt>
bool wait_in_slices(std::optional<double> timeout_s, const Attempt& attempt) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  for (;;) {
    std::chrono::nanoseconds slice = kSlice;
    if (timeout_s) {
      const auto left = std::chrono::duration<double>(*timeout_s) - (Clock::now() - begin);
      slice = std::clamp(std::chrono::duration_cast<std::chrono::nanoseconds>(left),
                         std::chrono::nanoseconds::zero(), slice);
    }
    if (attempt(slice)) return true;
    if (slice < std::chrono::nanoseconds(kSlice)) return false;
    check_signals();
  }
}

// An object is used by one thread at a time. A second one gets an exception.
class Exclusive {
 public:
  Exclusive(std::atomic<bool>& in_use, const char* what) : in_use_(in_use) {
    if (in_use_.exchange(true)) {
      throw std::runtime_error(std::string(what) +
                               " is in use by another thread; expected one thread at a time, so "
                               "make one object for each thread");
    }
  }
  ~Exclusive() { in_use_.store(false); }
  Exclusive(const Exclusive&) = delete;
  Exclusive& operator=(const Exclusive&) = delete;

 private:
  std::atomic<bool>& in_use_;
};

}  // namespace clearance::python
