// What is missing from streams whose samples are numbered.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace clearance {

class StreamGaps {
 public:
  // `kind` and `stream` name it: "batches" and "of source 'arm'". A number that is not larger is a
  // sender that started again.
  void note(const std::string& kind, const std::string& stream, std::uint64_t number);

  // Where streams begin later than with their first sample, and how many samples are missing after
  // that: a sentence each.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Stream {
    std::string kind;
    std::uint64_t first = 0, last = 0, missing = 0;
  };
  std::map<std::string, Stream> streams_;
};

}  // namespace clearance
