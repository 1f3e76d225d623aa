// Messages as Python sees them, by the field lists of monitor/wire/message_fields.hpp: a field that
// is new there is here, too.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "monitor/wire/slow_message_fields.hpp"
#include "tools/python/module/arrays.hpp"

namespace clearance::python {

// NumPy's name of a member's type; empty: a record cannot hold it.
template <class T>
[[nodiscard]] std::string numpy_type() {
  if constexpr (std::is_same_v<T, bool>) {
    return "?";
  } else if constexpr (std::is_floating_point_v<T>) {
    return "f" + std::to_string(sizeof(T));
  } else if constexpr (std::is_integral_v<T>) {
    return (std::is_signed_v<T> ? "i" : "u") + std::to_string(sizeof(T));
  } else if constexpr (std::is_same_v<T, clearance_msg_Vector3>) {
    return "3f8";
  } else {
    return "";
  }
}

// The dtype of records that are copies of such messages, without their texts.
template <class Message>
[[nodiscard]] const py::dtype& dtype_of() {
  // Never destroyed: the interpreter may be gone by then.
  static const auto* const dtype = [] {
    std::vector<std::string> types;
    std::vector<Field> fields;
    const Message message{};
    const auto add = [&]<class T>(const clearance::Field& field, const T& member) {
      const std::string type = numpy_type<T>();
      if (type.empty()) return;
      const auto* const begin = reinterpret_cast<const std::byte*>(&message);
      const auto* const at = reinterpret_cast<const std::byte*>(&member);
      fields.push_back({field.name, type, static_cast<std::size_t>(at - begin)});
    };
    for_each_field(add, message);
    return new py::dtype(record_dtype(fields, sizeof(Message)));
  }();
  return *dtype;
}

// True if a record of such messages would lose a text.
template <class Message>
[[nodiscard]] bool holds_text() {
  bool found = false;
  const Message message{};
  for_each_field([&found]<class T>(const clearance::Field&,
                                   const T&) { found = found || numpy_type<T>().empty(); },
                 message);
  return found;
}

template <class Message>
[[nodiscard]] py::dict fields_of(const Message& message);

// A number, a text, a record without its texts, or of a sequence an array: of numbers, of records,
// or a list of dicts where a record would lose a text.
template <class T>
[[nodiscard]] py::object value_of(const T& value) {
  if constexpr (std::is_arithmetic_v<T>) {
    return py::cast(value);
  } else if constexpr (std::is_same_v<T, clearance_msg_Vector3>) {
    return array_of({value.x, value.y, value.z});
  } else if constexpr (std::is_array_v<T> || std::is_pointer_v<T>) {
    return py::str(static_cast<const char*>(value));
  } else if constexpr (MessageSequence<T>) {
    using Element = std::remove_cvref_t<decltype(*value._buffer)>;
    if constexpr (std::is_arithmetic_v<Element>) {
      return py::array_t<Element>(static_cast<py::ssize_t>(value._length), value._buffer);
    } else {
      if (!holds_text<Element>())
        return records_of(dtype_of<Element>(), value._buffer, value._length);
      py::list items;
      for (std::uint32_t i = 0; i < value._length; ++i) items.append(fields_of(value._buffer[i]));
      return items;
    }
  } else {
    return records_of(dtype_of<T>(), &value, 1)[py::int_(0)];
  }
}

// The fields of a message by their names. One with texts is a dict, too.
template <class Message>
[[nodiscard]] py::dict fields_of(const Message& message) {
  py::dict fields;
  const auto add = [&fields]<class T>(const clearance::Field& field, const T& member) {
    const py::str name(field.name.data(), field.name.size());
    fields[name] = value_of(member);
    if constexpr (HasFields<T>)
      if (holds_text<T>()) fields[name] = fields_of(member);
  };
  for_each_field(add, message);
  return fields;
}

}  // namespace clearance::python
