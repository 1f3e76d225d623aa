// Takes messages of a topic one by one, as C structs.
#pragma once

#include <dds/dds.h>

#include <utility>

#include "monitor/wire/dds_sample.hpp"

namespace clearance::test {

// Takes the next message. Returns false if there is none, and leaves `last` as it was. A reader
// also gets samples without data, for instance when a writer ends; these are no messages.
template <class T>
[[nodiscard]] bool take_next(dds_entity_t reader, Sample<T>& last) {
  for (;;) {
    Sample<T> next;
    void* pointer = &*next;
    dds_sample_info_t info{};
    if (dds_take(reader, &pointer, &info, 1, 1) != 1) return false;
    if (!info.valid_data) continue;
    std::swap(*last, *next);
    return true;
  }
}

}  // namespace clearance::test
