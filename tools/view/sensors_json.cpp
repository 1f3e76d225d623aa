#include "tools/view/sensors_json.hpp"

#include <nlohmann/json.hpp>

namespace clearance::view {

std::string sensors_json(std::span<const SeenState> states) {
  nlohmann::json all = nlohmann::json::array();
  for (const SeenState& state : states) {
    nlohmann::json entry = {{"object", state.object},
                            {"stamp_ns", state.stamp_ns},
                            {"elements", state.elements},
                            {"frames", state.frames},
                            {"pose", nullptr},
                            {"refused", nlohmann::json::array()},
                            {"shells", nlohmann::json::object()}};
    if (state.world_from_sensor) {
      const Eigen::Quaterniond q = state.world_from_sensor->orientation.normalized();
      const Vec3& p = state.world_from_sensor->position;
      entry["pose"] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
    }
    for (const auto& [cause, count] : state.refused)
      entry["refused"].push_back({{"cause", cause}, {"count", count}});
    for (const auto& [object, thickness] : state.shells)
      entry["shells"][std::to_string(object)] = thickness;
    all.push_back(std::move(entry));
  }
  return all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace clearance::view
