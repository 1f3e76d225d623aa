// The slip of tests/mutants/*.slips that is made: the number in the environment variable
// CLEARANCE_SLIP, or none. Only builds with -DCLEARANCE_MUTANTS=ON include this.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <type_traits>

inline const int clearance_chosen_slip = [] {
  const char* number = std::getenv("CLEARANCE_SLIP");
  return number ? std::atoi(number) : 0;
}();

// Numbers of slips are below this.
inline constexpr int kClearanceSlips = 8192;

// One byte a slip, 1 as soon as a program comes to its place: a file that the environment variable
// CLEARANCE_REACHED names, shared with the programs that this one starts. None without it.
inline char* const clearance_reached = []() -> char* {
  const char* name = std::getenv("CLEARANCE_REACHED");
  const int file = name ? open(name, O_RDWR) : -1;
  if (file < 0) return nullptr;
  void* bytes = mmap(nullptr, kClearanceSlips, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  return bytes == MAP_FAILED ? nullptr : static_cast<char*>(bytes);
}();

// Whether the slip with this number is made. The compiler's own evaluation of constants has no
// slips.
constexpr bool clearance_slip(int number) {
  if (std::is_constant_evaluated()) return false;
  if (clearance_reached) clearance_reached[number] = 1;
  return clearance_chosen_slip == number;
}
