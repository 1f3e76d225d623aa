#include "tools/python/module/live/tick_messages.hpp"

#include <algorithm>
#include <limits>

#include "tools/python/module/live/fields.hpp"

namespace clearance::python {
namespace {

// The items of a sequence, each as a dict that `fill` fills.
template <class Sequence, class Fill>
py::list dicts_of(const Sequence& sequence, const Fill& fill) {
  py::list list;
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    py::dict item;
    fill(item, sequence._buffer[i]);
    list.append(item);
  }
  return list;
}

template <class Age>
void put_age(py::dict& item, const Age& age) {
  item["name"] = py::str(age.name);
  item["age_ns"] = age.age_ns;
  item["stale"] = age.stale;
  item["contradicted"] = age.contradicted;
  item["source"] = py::str(age.source);
  item["other_source"] = py::str(age.other_source);
}

py::dict partner_of(const clearance_msg_PartnerHealth& of) {
  py::dict partner;
  partner["partner"] = py::str(of.partner);
  partner["other"] = py::str(of.other);
  partner["standing"] = of.standing;
  partner["leads"] = of.leads;
  partner["other_publishes"] = of.other_publishes;
  partner["agrees_from"] = of.agrees_from;
  partner["compared"] = of.compared;
  partner["different"] = of.different;
  partner["other_inputs"] = of.other_inputs;
  partner["missing"] = of.missing;
  partner["phase_ns"] = of.phase_ns;
  return partner;
}

}  // namespace

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
    all[is_named ? py::object(py::str(state.name)) : py::object(names[id])] = value_of(state);
  }
  return all;
}

void put_response(py::dict& item, const clearance_msg_InputResponse& one) {
  item["input"] = py::str(one.input);
  item["p50_us"] = one.p50_us;
  item["max_us"] = one.max_us;
}

py::dict health_of(const clearance_msg_Health& m) {
  py::dict all;
  all["daemon"] = m.daemon;
  all["cycle"] = m.cycle;
  all["now_ns"] = m.now_ns;
  all["scene_revision"] = m.scene_revision;
  all["clock_steps"] = m.clock_steps;
  all["clock_offset_ns"] = m.clock_offset_ns;
  all["tick_p50_us"] = m.tick_p50_us;
  all["tick_p999_us"] = m.tick_p999_us;
  all["tick_max_us"] = m.tick_max_us;
  all["wakeup_p50_us"] = m.wakeup_p50_us;
  all["wakeup_p999_us"] = m.wakeup_p999_us;
  all["wakeup_max_us"] = m.wakeup_max_us;
  all["response_p50_us"] = m.response_p50_us;
  all["response_p999_us"] = m.response_p999_us;
  all["response_max_us"] = m.response_max_us;
  all["tick_second_max_us"] = m.tick_second_max_us;
  all["wakeup_second_max_us"] = m.wakeup_second_max_us;
  all["overruns"] = m.overruns;
  all["skipped_cycles"] = m.skipped_cycles;
  all["batches"] = m.batches;
  all["lost_batches"] = m.lost_batches;
  all["undecodable_samples"] = m.undecodable_samples;
  all["dropped_reports"] = m.dropped_reports;
  all["other_writers"] = m.other_writers;
  all["foreign_reports"] = m.foreign_reports;
  all["rejected"] = dicts_of(m.rejected, [](py::dict& item, const auto& one) {
    item["object"] = py::str(one.object);
    item["cause"] = py::str(one.cause);
    item["count"] = one.count;
    item["last"] = py::str(one.last);
  });
  all["inputs"] = dicts_of(m.inputs, [](py::dict& item, const auto& one) {
    put_age(item, one);
    item["follows_joints"] = one.follows_joints;
  });
  all["joints"] = dicts_of(m.joints, [](py::dict& item, const auto& one) { put_age(item, one); });
  all["sources"] = dicts_of(m.sources, [](py::dict& item, const auto& one) {
    item["source"] = py::str(one.source);
    item["batches"] = one.batches;
    item["lost_batches"] = one.lost_batches;
    item["cut_poses"] = one.cut_poses;
    item["age_ns"] = one.age_ns;
  });
  all["late_responses"] = m.late_responses;
  all["responses"] = dicts_of(m.responses, put_response);
  all["recording"] = py::str(m.recording);
  all["recording_missing"] = m.recording_missing;
  all["notes"] = dicts_of(m.notes, [](py::dict& item, const auto& one) {
    item["input"] = py::str(one.input);
    item["takeovers"] = one.takeovers;
    item["source"] = py::str(one.source);
    item["former_source"] = py::str(one.former_source);
    item["velocities_contradict"] = one.velocities_contradict;
  });
  all["partner"] = partner_of(m.partner);
  all["shares"] = dicts_of(m.shares, [](py::dict& item, const auto& one) {
    item["share"] = py::str(one.share);
    item["state"] = one.state;
    item["daemon"] = one.daemon;
    item["cycle"] = one.cycle;
    item["scene_revision"] = one.scene_revision;
    item["age_ns"] = one.age_ns;
  });
  all["witnesses"] = dicts_of(m.witnesses, [](py::dict& item, const auto& one) {
    item["sensor"] = py::str(one.sensor);
    item["robot"] = py::str(one.robot);
    item["link"] = py::str(one.link);
    item["agreeing"] = one.agreeing;
    item["through"] = one.through;
    item["denied"] = one.denied;
    item["residual_p50"] = one.residual_p50;
    item["residual_p90"] = one.residual_p90;
  });
  return all;
}

}  // namespace clearance::python
