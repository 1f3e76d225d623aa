// Writes a reduction as a table, as JSON, and as parts of a cell.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/yaml/yaml_emitter.hpp"
#include "tools/scene/reduction.hpp"

namespace clearance {
namespace {

// Writing a plane in decimals and reading it again may move it by this share of its distance from
// the origin.
constexpr double kPlaneSlack = 1e-14;

std::string list(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", shortest(v.x()), shortest(v.y()), shortest(v.z()));
}

std::string polyhedron_text(const ConvexBody& shape) {
  std::string text = "polyhedron:\n    half_spaces:\n";
  for (const Facet& facet : shape.facets) {
    const double slack = kPlaneSlack * shape.bounding_radius + 4.0 * shape.position_error;
    text += fmt::format("      - {{normal: {}, offset: {}}}\n", list(facet.normal),
                        shortest(facet.offset + slack));
  }
  return text;
}

std::string shape_text(const EnclosingModel& model) {
  const ConvexBody& shape = model.shape;
  const auto& discs = shape.curved.discs;
  switch (model.kind) {
    case ModelKind::kSphere:
      return fmt::format("sphere: {{radius: {}}}\n", shortest(shape.radius));
    case ModelKind::kCapsule:
      if (shape.anchors.size() == 1) {
        return fmt::format("sphere: {{radius: {}}}\n", shortest(shape.radius));
      }
      return fmt::format("capsule: {{from: {}, to: {}, radius: {}}}\n", list(shape.anchors[0]),
                         list(shape.anchors[1]), shortest(shape.radius));
    case ModelKind::kBox:
    case ModelKind::kRoundedBox: {
      Vec3 half = Vec3::Zero();
      for (const Vec3& p : shape.anchors) half = half.cwiseMax(p);
      const std::string rounding =
          shape.radius > 0.0 ? fmt::format(", rounding: {}", shortest(shape.radius)) : "";
      return fmt::format("box: {{size: {}{}}}\n", list(2.0 * half), rounding);
    }
    case ModelKind::kCylinder:
      return fmt::format("cylinder: {{radius: {}, length: {}}}\n", shortest(discs[0].radius),
                         shortest(2.0 * discs[1].height));
    case ModelKind::kEllipsoid:
      return fmt::format("ellipsoid: {{semi_axes: {}}}\n", list(shape.curved.semi_axes));
    case ModelKind::kPolyhedron:
      break;
  }
  return polyhedron_text(shape);
}

std::string part_yaml(const EnclosingModel& model) {
  const Pose& pose = model.frame_from_shape;
  const Eigen::Quaterniond& q = pose.orientation;
  return fmt::format("- pose: {{xyz: {}, quaternion: [{}, {}, {}, {}]}}\n  {}", list(pose.position),
                     shortest(q.x()), shortest(q.y()), shortest(q.z()), shortest(q.w()),
                     shape_text(model));
}

std::string line(const Reduction& body, std::size_t i) {
  const ReducedModel& model = body.models[i];
  const auto time = [&](double QueryTimes::*which) {
    return model.time ? fmt::format("{:.0f}", *model.time.*which) : std::string("-");
  };
  return fmt::format("{} {:<12} {:>6} {:>9.5f} {:>7} {:>7}\n", body.chosen == i ? "*" : " ",
                     model.name, model.facets() > 0 ? fmt::format("{}", model.facets()) : "-",
                     rounded_up_error(model.error), time(&QueryTimes::tracked),
                     time(&QueryTimes::cold));
}

std::string cheapest_lines(const Reduction& body, const ReductionOptions& options) {
  if (options.distances.empty()) return {};
  const std::vector<Level> levels = levels_of(body);
  std::string text;
  for (const double distance : options.distances) {
    const Watching watching{distance, options.speed};
    const auto best = cheapest(levels, watching);
    text += fmt::format("at {:g} m and {:g} m/s: ", distance, options.speed);
    if (!best) {
      text += "in every tick, by the body itself\n";
      continue;
    }
    const auto cost = watch_cost(levels[*best], watching);
    text += fmt::format("{}, {:.3g} looks a second, {:.3g} us\n", label_of(body.models[*best]),
                        cost->looks_per_s, 1e-3 * cost->ns_per_s);
  }
  text += "cheapest:";
  for (const CheapestFrom& from : cheapest_by_distance(levels, options.speed)) {
    text += fmt::format(" {} from {:.3g} m,", label_of(body.models[from.level]), from.distance);
  }
  text.back() = '\n';
  return text;
}

nlohmann::ordered_json json_of(const Reduction& body, std::size_t i) {
  const ReducedModel& model = body.models[i];
  nlohmann::ordered_json one{
      {"model", model.name}, {"facets", model.facets()}, {"error", model.error}};
  if (model.time) {
    one["ns"] = model.time->tracked;
    one["ns_cold"] = model.time->cold;
  }
  one["chosen"] = body.chosen == i;
  one["part"] = parts_yaml(model);
  return one;
}

nlohmann::ordered_json cheapest_json(const Reduction& body, const ReductionOptions& options) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  const std::vector<Level> levels = levels_of(body);
  for (const double distance : options.distances) {
    const Watching watching{distance, options.speed};
    nlohmann::ordered_json one{{"distance", distance}, {"speed", options.speed}};
    if (const auto best = cheapest(levels, watching)) {
      const auto cost = watch_cost(levels[*best], watching);
      one["model"] = label_of(body.models[*best]);
      one["looks_per_s"] = cost->looks_per_s;
      one["ns_per_s"] = cost->ns_per_s;
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace

std::string label_of(const ReducedModel& model) {
  return model.name == name(ModelKind::kPolyhedron) ? fmt::format("{} facets", model.facets())
                                                    : model.name;
}

double rounded_up_error(double error) {
  return error > 1e-12 ? 1e-5 * std::ceil(1e5 * error) : 0.0;
}

std::string parts_yaml(const ReducedModel& model) {
  std::string text;
  for (const EnclosingModel& part : model.parts) text += part_yaml(part);
  return text;
}

std::string reduction_table(const std::vector<Reduction>& bodies, const ReductionOptions& options) {
  std::string text;
  for (const Reduction& body : bodies) {
    text += fmt::format("{}: hull of {} facets, {} vertices\n  {:<12} {:>6} {:>9} {:>7} {:>7}\n",
                        body.name, body.facets, body.vertices, "model", "facets", "error m", "ns",
                        "cold");
    for (std::size_t i = 0; i < body.models.size(); ++i) text += line(body, i);
    text += cheapest_lines(body, options);
    if (body.chosen) text += "# parts, lengths in m\n" + parts_yaml(body.models[*body.chosen]);
    text += "\n";
  }
  text +=
      "error: no point of the model's surface is farther than this from the body; rounded upwards\n"
      "ns, cold: a query against a box, tracked and not; of parts, all of them (--time)\n"
      "*: chosen by --tolerance or --facets\n";
  if (options.distances.empty()) return text;
  return text +
         "at: the model by which it costs least to know at all times that a pair at that distance "
         "beyond a zone's threshold is not inside, with objects that come so far a second\n";
}

std::string reduction_json(const std::vector<Reduction>& bodies, const ReductionOptions& options) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Reduction& body : bodies) {
    nlohmann::ordered_json models = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < body.models.size(); ++i) models.push_back(json_of(body, i));
    nlohmann::ordered_json one{{"body", body.name},
                               {"facets", body.facets},
                               {"vertices", body.vertices},
                               {"models", std::move(models)}};
    if (!options.distances.empty()) one["cheapest"] = cheapest_json(body, options);
    all.push_back(std::move(one));
  }
  return fmt::format("{}\n", all.dump(1));
}

}  // namespace clearance
