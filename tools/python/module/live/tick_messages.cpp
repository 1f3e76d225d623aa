#include "tools/python/module/live/tick_messages.hpp"

#include <algorithm>
#include <limits>

#include "tools/python/module/live/fields.hpp"

namespace clearance::python {
GradientArrays gradient_arrays(const clearance_msg_Gradients& message,
                               const std::vector<std::uint32_t>& pairs, std::size_t joints) {
  const auto rows = static_cast<py::ssize_t>(pairs.size());
  Doubles rates({rows, static_cast<py::ssize_t>(joints)});
  Doubles drifts(rows);
  double* const rate = rates.mutable_data();
  std::fill_n(rate, pairs.size() * joints, std::numeric_limits<double>::quiet_NaN());
  std::fill_n(drifts.mutable_data(), pairs.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::uint32_t i = 0; i < message.pairs._length; ++i) {
    const clearance_msg_PairGradient& pair = message.pairs._buffer[i];
    const auto found = std::ranges::find(pairs, pair.pair);
    if (found == pairs.end()) continue;
    const auto row = static_cast<std::size_t>(found - pairs.begin());
    drifts.mutable_data()[row] = pair.drift;
    std::fill_n(rate + row * joints, joints, 0.0);  // joints that do not move the pair
    for (std::uint32_t j = 0; j < pair.joints._length; ++j) {
      const clearance_msg_JointGradient& one = pair.joints._buffer[j];
      if (one.joint < joints) rate[row * joints + one.joint] = one.rate;
    }
  }
  return {rates, drifts};
}

py::dict zones_of(const ZoneStates& zones, const py::list& names) {
  py::dict all;
  for (const auto& [id, state] : zones) {
    const bool is_named = *state.name != '\0' || id >= names.size();
    const py::object name = is_named ? py::object(py::str(state.name)) : py::object(names[id]);
    // While the cell changes, two ids may have one name: an active state counts.
    if (state.active || !all.contains(name)) all[name] = value_of(state);
  }
  return all;
}

py::dict health_of(const clearance_msg_Health& message) { return fields_of(message); }

}  // namespace clearance::python
