// Names the columns of a pose log; the table does the rest.
#include "monitor/files/pose_log.hpp"

#include <array>
#include <string_view>

namespace clearance {
namespace {

constexpr std::array<std::string_view, 9> kColumnNames = {"t_ns", "object", "px", "py", "pz",
                                                          "qw",   "qx",     "qy", "qz"};
// Places in kColumnNames.
enum Column : std::size_t { kTime, kObject, kX, kY, kZ, kW, kQx, kQy, kQz };

}  // namespace

CsvPoseLog::CsvPoseLog(const std::filesystem::path& file) : table_(file, kColumnNames) {}

// The first field that cannot be read ends the log, with its line and column name in the error.
bool CsvPoseLog::next(CsvPose& pose) {
  if (!table_.next() || !table_.time_ns(kTime, pose.t_ns)) return false;
  pose.object = table_.text(kObject);
  if (pose.object.empty()) return table_.fail("names no object; expected its name in the cell");
  Vec3& p = pose.world_from_object.position;
  Eigen::Quaterniond& q = pose.world_from_object.orientation;
  return table_.number(kX, p.x()) && table_.number(kY, p.y()) && table_.number(kZ, p.z()) &&
         table_.number(kW, q.w()) && table_.number(kQx, q.x()) && table_.number(kQy, q.y()) &&
         table_.number(kQz, q.z());
}

}  // namespace clearance
