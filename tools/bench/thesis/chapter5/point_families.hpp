// Seeded ellipsoids and points on which the methods of §5.1 are compared.
#pragma once

#include <string>
#include <vector>

#include "core/vec.hpp"

namespace clearance::bench {

struct PointCase {
  Vec3 axes, p;
  double distance;  // true, of 50 digits, to the surface
  [[nodiscard]] double size() const { return axes.maxCoeff() + p.norm(); }
};

struct PointFamily {
  const char* name;
  const char* what;
};
inline constexpr PointFamily kPointFamilies[] = {
    {"thesis", "(5.1.9): a = [1..100, 1, 0.1..1], p in a cube of 200"},
    {"ratios", "semi-axes in ratios up to 1e6, discs and needles, p up to twice as far out"},
    {"surface", "off the surface by 1e-16 to 1e-3 of themselves, on either side"},
    {"inside", "anywhere inside"},
    {"centre", "1e-12 to 1e-2 of the semi-axes from the centre"},
    {"axes", "on an axis, inside and outside"},
};
// 1,000 of them.
[[nodiscard]] std::vector<PointCase> point_cases(const std::string& family);

}  // namespace clearance::bench
