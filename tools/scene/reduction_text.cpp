// What a reduction looks like: a table, JSON, and parts of a cell.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/yaml_emitter.hpp"
#include "tools/scene/reduction.hpp"

namespace clearance {
namespace {

// What writing a plane in decimals and making it a facet again may cut off, of its distance from
// the origin.
constexpr double kPlaneSlack = 1e-14;

std::string list(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", shortest(v.x()), shortest(v.y()), shortest(v.z()));
}

std::string polyhedron_text(const ConvexPolyhedron& shape) {
  std::string text = "polyhedron:\n    half_spaces:\n";
  for (const Facet& facet : shape.facets) {
    const double slack = kPlaneSlack * shape.bounding_radius + 4.0 * shape.position_error;
    text += fmt::format("      - {{normal: {}, offset: {}}}\n", list(facet.normal),
                        shortest(facet.offset + slack));
  }
  return text;
}

std::string shape_text(const EnclosingModel& model) {
  const ConvexPolyhedron& shape = model.shape;
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

std::string line(const Reduction& body, std::size_t i) {
  const EnclosingModel& model = body.models[i];
  const std::size_t facets = model.shape.facets.size();
  const bool itself = i + 1 == body.models.size();
  return fmt::format("{} {:<12} {:>6} {:>9.5f} {:>7}\n", body.chosen == i ? "*" : " ",
                     itself ? "body itself" : name(model.kind),
                     facets > 0 ? fmt::format("{}", facets) : "-",
                     1e-5 * std::ceil(1e5 * (itself ? 0.0 : model.error)),
                     body.query_ns.empty() ? "-" : fmt::format("{:.0f}", body.query_ns[i]));
}

}  // namespace

std::string part_yaml(const EnclosingModel& model) {
  const Pose& pose = model.frame_from_shape;
  const Eigen::Quaterniond& q = pose.orientation;
  return fmt::format("- pose: {{xyz: {}, quaternion: [{}, {}, {}, {}]}}\n  {}", list(pose.position),
                     shortest(q.x()), shortest(q.y()), shortest(q.z()), shortest(q.w()),
                     shape_text(model));
}

std::string reduction_table(const std::vector<Reduction>& bodies) {
  std::string text;
  for (const Reduction& body : bodies) {
    text += fmt::format("{}: hull of {} facets, {} vertices\n  {:<12} {:>6} {:>9} {:>7}\n",
                        body.name, body.facets, body.vertices, "model", "facets", "error m", "ns");
    for (std::size_t i = 0; i < body.models.size(); ++i) text += line(body, i);
    if (body.chosen) text += "# parts, lengths in m\n" + part_yaml(body.models[*body.chosen]);
    text += "\n";
  }
  return text +
         "error: no point of the model is farther than this from the body; rounded upwards\n"
         "ns: a tracked query against a box (--time)\n"
         "*: chosen by --tolerance or --facets\n";
}

std::string reduction_json(const std::vector<Reduction>& bodies) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Reduction& body : bodies) {
    nlohmann::ordered_json models = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < body.models.size(); ++i) {
      const EnclosingModel& model = body.models[i];
      nlohmann::ordered_json one{{"model", name(model.kind)},
                                 {"facets", model.shape.facets.size()},
                                 {"error", model.error}};
      if (!body.query_ns.empty()) one["ns"] = body.query_ns[i];
      one["chosen"] = body.chosen == i;
      one["part"] = part_yaml(model);
      models.push_back(std::move(one));
    }
    all.push_back({{"body", body.name},
                   {"facets", body.facets},
                   {"vertices", body.vertices},
                   {"models", std::move(models)}});
  }
  return fmt::format("{}\n", all.dump(1));
}

}  // namespace clearance
