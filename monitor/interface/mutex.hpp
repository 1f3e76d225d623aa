// A mutex that states what it guards. Clang checks it (-Wthread-safety, by tools/analyse); other
// compilers see no attributes. The macros have the names of Clang's documentation.
#pragma once

#include <mutex>

#ifdef __clang__
#define CLEARANCE_THREAD_SAFETY(attribute) __attribute__((attribute))
#else
#define CLEARANCE_THREAD_SAFETY(attribute)
#endif
// Before a variable: it is read and written only while this mutex is locked. Constructors and
// destructors may do so without it.
#define GUARDED_BY(mutex) CLEARANCE_THREAD_SAFETY(guarded_by(mutex))
// Behind the parameters of a function or lambda: the caller has locked this mutex.
#define REQUIRES(mutex) CLEARANCE_THREAD_SAFETY(requires_capability(mutex))

namespace clearance {

class CLEARANCE_THREAD_SAFETY(capability("mutex")) Mutex : public std::mutex {};

// Holds a mutex until the end of the scope. Condition variables wait with it.
class CLEARANCE_THREAD_SAFETY(scoped_lockable) Lock : public std::unique_lock<std::mutex> {
 public:
  explicit Lock(Mutex& mutex) CLEARANCE_THREAD_SAFETY(acquire_capability(mutex))
      : unique_lock(mutex) {}
  ~Lock() CLEARANCE_THREAD_SAFETY(release_capability()) = default;

  void lock() CLEARANCE_THREAD_SAFETY(acquire_capability()) { unique_lock::lock(); }
  void unlock() CLEARANCE_THREAD_SAFETY(release_capability()) { unique_lock::unlock(); }
};

}  // namespace clearance
