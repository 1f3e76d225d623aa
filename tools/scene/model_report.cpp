#include "tools/scene/model_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/enclosing_polyhedron.hpp"
#include "core/query_tables.hpp"
#include "core/shapes.hpp"
#include "monitor/bodies/bounding_hull.hpp"
#include "monitor/bodies/bounding_sphere.hpp"
#include "tools/scene/certified_error.hpp"

namespace clearance {
namespace {

struct Size {
  std::size_t facets = 0, vertices = 0, bytes = 0;
};

Size size_of(const ConvexBody& p) { return {p.facets.size(), p.vertices.size(), footprint(p)}; }

struct Hull {
  Size size;
  double error = 0.0;  // m
};

struct Models {
  const Object* object = nullptr;
  double sphere_radius = kInfinity, sphere_error = kInfinity;  // m
  std::optional<Hull> hull;
  Size full;
  std::size_t curved = 0;   // parts that are no polyhedra
  double full_error = 0.0;  // rounding of its numbers, m
  std::optional<double> mesh_error;
};

double sphere_error(const Sphere& sphere, const std::vector<PlacedShape>& shapes) {
  const ConvexBody ball = std::get<ConvexBody>(point(Vec3::Zero(), sphere.radius));
  return certified_error(ball, Pose{.position = sphere.centre}, shapes);
}

// Objects with the same parts share their hull, so its error is computed once.
class Judge {
 public:
  explicit Judge(const Scene& scene)
      : hulls_(bounding_hulls(scene)),
        spheres_(bounding_spheres(scene.objects.size(), parts_of(scene))) {}

  Models models(const Scene& scene, std::size_t i) {
    const Object& object = scene.objects[i];
    Models all;
    all.object = &object;
    const std::vector<PlacedShape> shapes = shapes_of(object);
    const Sphere& sphere = spheres_[i].in_object;
    if (sphere.radius < kInfinity) {
      all.sphere_radius = sphere.radius;
      all.sphere_error = sphere_error(sphere, shapes);
    }
    if (hulls_[i]) all.hull = {size_of(*hulls_[i]), hull_error(i, shapes)};
    for (const Part& part : object.parts) {
      const Size size = size_of(part.shape);
      all.full.facets += size.facets;
      all.full.vertices += size.vertices;
      all.full.bytes += size.bytes;
      all.curved += part.shape.is_curved() ? 1 : 0;
      all.full_error = std::max(all.full_error, part.shape.position_error);
    }
    return all;
  }

 private:
  double hull_error(std::size_t i, const std::vector<PlacedShape>& shapes) {
    for (const auto& [hull, error] : errors_) {
      if (hull == hulls_[i].get()) return error;
    }
    errors_.emplace_back(hulls_[i].get(), certified_error(*hulls_[i], Pose{}, shapes));
    return errors_.back().second;
  }

  std::vector<BoundingHull> hulls_;
  std::vector<BoundingSphere> spheres_;
  std::vector<std::pair<const ConvexBody*, double>> errors_;
};

std::vector<Models> all_models(const Scene& scene, const MeshErrors& mesh_errors) {
  Judge judge(scene);
  std::vector<Models> all;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    all.push_back(judge.models(scene, i));
    const auto error = mesh_errors.find(scene.objects[i].name);
    if (error != mesh_errors.end()) all.back().mesh_error = error->second;
  }
  return all;
}

std::string kib(std::size_t bytes) {
  return fmt::format("{:.1f}", static_cast<double>(bytes) / 1024.0);
}

// Rounded upwards, so that the printed number is still a bound.
std::string metres(double length) {
  return length < kInfinity ? fmt::format("{:.4f}", 1e-4 * std::ceil(1e4 * length))
                            : std::string("-");
}

std::string line(const Models& m, std::size_t width) {
  std::string hull = fmt::format("{:>6} {:>6} {:>8} {:>6}", "-", "-", "-", "-");
  if (m.hull) {
    hull = fmt::format("{:>6} {:>6} {:>8} {:>6}", m.hull->size.facets, m.hull->size.vertices,
                       metres(m.hull->error), kib(m.hull->size.bytes));
  }
  return fmt::format("{:<{}} | {:>8} {:>8} | {} | {:>5} {:>6} {:>6} {:>6} {:>8.1e} {:>8} {:>6}\n",
                     m.object->name, width, metres(m.sphere_radius), metres(m.sphere_error), hull,
                     m.object->parts.size(), m.curved, m.full.facets, m.full.vertices, m.full_error,
                     m.mesh_error ? metres(*m.mesh_error) : "-", kib(m.full.bytes));
}

}  // namespace

std::string model_table(const Scene& scene, const MeshErrors& mesh_errors) {
  std::size_t width = 6;
  for (const Object& object : scene.objects) width = std::max(width, object.name.size());
  std::string text =
      fmt::format("{:<{}} | {:^17} | {:^29} | {:^51}\n", "", width, "sphere", "hull", "full") +
      fmt::format(
          "{:<{}} | {:>8} {:>8} | {:>6} {:>6} {:>8} {:>6} | {:>5} {:>6} {:>6} {:>6} {:>8} {:>8} "
          "{:>6}\n",
          "object", width, "radius m", "error m", "facets", "verts", "error m", "KiB", "parts",
          "curved", "facets", "verts", "error m", "mesh m", "KiB");
  std::size_t hull_bytes = 0, full_bytes = 0, hulls = 0;
  for (const Models& m : all_models(scene, mesh_errors)) {
    text += line(m, width);
    full_bytes += m.full.bytes;
    if (!m.hull) continue;
    ++hulls;
    hull_bytes += m.hull->size.bytes;
  }
  return text +
         fmt::format(
             "{} objects, {} with a hull: {} KiB if none were shared, beside {} KiB of full "
             "models\n"
             "error: no point of a model is farther than this from the object's nearest "
             "part; of full ones, the rounding of their numbers\n"
             "curved: parts that are ellipsoids, cylinders or cones, without facets\n"
             "mesh: no point of the parts' surface is farther than this from the meshes that they "
             "contain\n"
             "-: unbounded; one simple part, which is evaluated without a coarser model; no mesh\n",
             scene.objects.size(), hulls, kib(hull_bytes), kib(full_bytes));
}

std::string model_json(const Scene& scene, const MeshErrors& mesh_errors) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  const auto size = [](const Size& s) {
    return nlohmann::ordered_json{
        {"facets", s.facets}, {"vertices", s.vertices}, {"bytes", s.bytes}};
  };
  for (const Models& m : all_models(scene, mesh_errors)) {
    nlohmann::ordered_json object{{"object", m.object->name}};
    if (m.sphere_radius < kInfinity) {
      object["sphere"] = {{"radius", m.sphere_radius}, {"error", m.sphere_error}};
    }
    if (m.hull) {
      object["hull"] = size(m.hull->size);
      object["hull"]["error"] = m.hull->error;
    }
    object["full"] = size(m.full);
    object["full"]["parts"] = m.object->parts.size();
    object["full"]["curved"] = m.curved;
    object["full"]["error"] = m.full_error;
    if (m.mesh_error) object["full"]["mesh_error"] = *m.mesh_error;
    all.push_back(std::move(object));
  }
  return fmt::format("{}\n", all.dump(1));
}

}  // namespace clearance
