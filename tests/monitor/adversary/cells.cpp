#include "tests/monitor/adversary/cells.hpp"

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

// A part with more than 64 facets gets a bounding hull.
Part hull(Random& random, int points, double size, const Pose& offset) {
  std::vector<Vec3> vertices;
  for (int i = 0; i < points; ++i) vertices.push_back(random.in_box(size));
  if (points > 20) {
    for (Vec3& vertex : vertices) vertex = size * vertex.normalized();
  }
  return {"hull", made(polyhedron_from_vertices(vertices)), offset};
}

}  // namespace

Scene thin_bodies(Random& random) {
  std::vector<Object> objects;
  for (int i = 0; i < 6; ++i) {
    objects.push_back(moving("thin", {capsule(2.0, 0.005, random.pose(0.5))}));
  }
  objects.push_back(
      moving("two", {capsule(1.0, 0.01, random.pose(1.0)), ball(0.05, random.pose(1.0))}));
  for (int i = 0; i < 6; ++i) {
    objects.push_back(fixed("post", {capsule(1.0, 0.02)}, random.pose(3.0)));
  }
  return cell_of(std::move(objects));
}

Scene capsules(Random& random) {
  std::vector<Object> objects;
  for (int i = 0; i < 22; ++i) {
    const Part part = i % 3 == 0 ? ball(0.05, random.pose(0.2))
                                 : capsule(random.uniform(0.3, 1.5), 0.01, random.pose(0.2));
    Object object = i < 16 ? moving("body", {part}) : fixed("post", {part}, random.pose(2.5));
    if (i % 2 == 0) object.max_speed = 3.0;
    object.margin = i % 4 == 0 ? 0.01 : 0.0;
    objects.push_back(std::move(object));
  }
  Scene scene = cell_of(std::move(objects));
  scene.zones = {zone_over(scene, 0.03, 0.05), zone_over(scene, 0.3, 0.3)};
  scene.zones[0].pairs.resize(80);
  scene.zones[1].pairs.erase(scene.zones[1].pairs.begin(), scene.zones[1].pairs.begin() + 120);
  for (std::size_t p = 0; p < scene.pairs.size(); p += 50) scene.pairs[p].publish = true;
  return scene;
}

Scene polyhedra(Random& random) {
  const Part needle = block({0.4, 0.004, 0.004}, random.pose(0.1));
  std::vector<Object> objects;
  for (int i = 0; i < 3; ++i) {
    objects.push_back(moving("needle", {needle}));
    objects.push_back(moving("hull", {hull(random, 12, 0.15, random.pose(0.1))}));
  }
  objects.push_back(moving("two", {hull(random, 12, 0.1, random.pose(0.3)), needle}));
  objects.push_back(moving("pebble", {hull(random, 60, 0.1, {})}));
  objects.push_back(moving("plate", {block({0.3, 0.3, 0.002})}));
  objects.push_back(fixed("floor", {floor()}, at(0, 0, -1.2)));
  for (int i = 0; i < 3; ++i) {
    objects.push_back(fixed("wall", {block({0.4, 0.4, 0.002})}, random.pose(1.0)));
  }
  for (std::size_t i = 0; i < objects.size(); i += 2) {
    objects[i].max_speed = 3.0;
    objects[i].margin = 0.005;
  }
  Scene scene = cell_of(std::move(objects));
  scene.refresh_s = 0.2;
  scene.zones = {zone_over(scene, 0.0, 0.02), zone_over(scene, 0.2, 0.25)};
  scene.zones[0].pairs.resize(40);
  scene.zones[1].pairs.erase(scene.zones[1].pairs.begin(), scene.zones[1].pairs.begin() + 20);
  for (std::size_t p = 0; p < scene.pairs.size(); p += 7) scene.pairs[p].publish = true;
  return scene;
}

}  // namespace clearance::test
