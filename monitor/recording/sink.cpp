#include "monitor/recording/sink.hpp"

namespace clearance {

std::string ContinuousFiles::begin_scene(const Cell& cell, const clearance_msg_Catalogue& catalogue,
                                         std::int64_t log_ns) {
  std::string missing = writer_.attach(cell);
  writer_.catalogue(catalogue, log_ns);
  return missing;
}

}  // namespace clearance
