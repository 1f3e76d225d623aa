#include "tests/shared/vertex_enumeration.hpp"

#include <algorithm>
#include <cmath>

#include "tests/shared/exact_placement.hpp"

namespace clearance::oracle {
namespace {

RationalVec rational(const IntegerVec& v) {
  return {Rational(v[0]), Rational(v[1]), Rational(v[2])};
}

struct Plane {
  RationalVec normal;
  Rational offset;
};

std::vector<Integer> shortest(const Plane& plane) {
  Integer common = plane.offset.get_den();
  for (const Rational& x : plane.normal) common = lcm(common, x.get_den());
  std::vector<Integer> result;
  Integer divisor = 0;
  for (const Rational& x : {plane.normal[0], plane.normal[1], plane.normal[2], plane.offset}) {
    result.emplace_back(x.get_num() * (common / x.get_den()));
    divisor = gcd(divisor, result.back());
  }
  for (Integer& x : result) x /= divisor;
  return result;
}

// Returns true if the vectors span at least a plane.
bool span_a_plane(const std::vector<RationalVec>& vectors) {
  for (const RationalVec& v : vectors) {
    if (!is_zero(cross(vectors[0], v))) return true;
  }
  return false;
}

void add_vertices(const std::vector<Plane>& planes, Enumeration& result) {
  const auto below_all = [&](const RationalVec& x) {
    return std::all_of(planes.begin(), planes.end(),
                       [&](const Plane& p) { return dot(p.normal, x) <= p.offset; });
  };
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const RationalVec line = cross(planes[i].normal, planes[j].normal);
      if (is_zero(line)) continue;
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        const Rational determinant = dot(line, planes[k].normal);
        if (determinant == 0) continue;
        const RationalVec jk = cross(planes[j].normal, planes[k].normal);
        const RationalVec ki = cross(planes[k].normal, planes[i].normal);
        RationalVec x;
        for (std::size_t c = 0; c < 3; ++c) {
          x[c] =
              (planes[i].offset * jk[c] + planes[j].offset * ki[c] + planes[k].offset * line[c]) /
              determinant;
        }
        if (below_all(x)) result.vertices.insert(x);
      }
    }
  }
}

void add_rays(const std::vector<Plane>& planes, Enumeration& result) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      RationalVec ray = cross(planes[i].normal, planes[j].normal);
      if (is_zero(ray)) continue;
      for (const int sign : {1, -1}) {
        for (Rational& x : ray) x *= sign;
        if (std::all_of(planes.begin(), planes.end(),
                        [&](const Plane& p) { return dot(p.normal, ray) <= 0; })) {
          result.rays.insert(primitive(ray));
        }
      }
    }
  }
}

}  // namespace

Enumeration enumerate(std::span<const HalfSpace> rows) {
  std::vector<Plane> planes;
  for (const HalfSpace& row : rows) planes.push_back({exact(row.normal), Rational(row.offset)});
  Enumeration result;
  add_vertices(planes, result);
  add_rays(planes, result);
  for (const Plane& plane : planes) {
    std::vector<RationalVec> within;  // directions between points of the plane
    const RationalVec* first = nullptr;
    for (const RationalVec& vertex : result.vertices) {
      if (dot(plane.normal, vertex) != plane.offset) continue;
      if (first == nullptr) {
        first = &vertex;
      } else {
        within.push_back(vertex - *first);
      }
    }
    if (first == nullptr) continue;
    for (const IntegerVec& ray : result.rays) {
      if (dot(plane.normal, rational(ray)) == 0) within.push_back(rational(ray));
    }
    if (span_a_plane(within)) result.facets.insert(shortest(plane));
  }
  return result;
}

HullEnumeration enumerate_hull(std::span<const Vec3> points) {
  std::vector<RationalVec> p;
  for (const Vec3& point : points) p.push_back(exact(point));
  std::vector<Plane> planes;
  HullEnumeration result;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      for (std::size_t k = j + 1; k < p.size(); ++k) {
        RationalVec normal = cross(p[j] - p[i], p[k] - p[i]);
        if (is_zero(normal)) continue;
        for (const int sign : {1, -1}) {
          for (Rational& x : normal) x *= sign;
          const Plane plane{normal, dot(normal, p[i])};
          if (!std::all_of(p.begin(), p.end(), [&](const RationalVec& q) {
                return dot(plane.normal, q) <= plane.offset;
              })) {
            continue;
          }
          if (result.facets.insert(shortest(plane)).second) planes.push_back(plane);
        }
      }
    }
  }
  // A point is a vertex if three planes with independent normals meet there.
  for (const RationalVec& point : p) {
    std::vector<RationalVec> normals;
    for (const Plane& plane : planes) {
      if (dot(plane.normal, point) == plane.offset) normals.push_back(plane.normal);
    }
    bool corner = false;
    for (std::size_t i = 1; i < normals.size(); ++i) {
      for (std::size_t j = i + 1; j < normals.size(); ++j) {
        corner = corner || dot(cross(normals[0], normals[i]), normals[j]) != 0;
      }
    }
    if (corner) result.vertices.insert(point);
  }
  return result;
}

bool is_nearest(double rounded, const Rational& exact) {
  const Rational error = abs(Rational(Rational(rounded) - exact));
  for (const double towards : {-kInfinity, kInfinity}) {
    const Rational neighbour(std::nextafter(rounded, towards));
    if (abs(Rational(neighbour - exact)) < error) return false;
  }
  return true;
}

bool is_nearest(const Vec3& rounded, const RationalVec& exact) {
  return is_nearest(rounded.x(), exact[0]) && is_nearest(rounded.y(), exact[1]) &&
         is_nearest(rounded.z(), exact[2]);
}

}  // namespace clearance::oracle
