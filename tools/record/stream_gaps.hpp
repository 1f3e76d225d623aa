// Finds gaps in streams whose samples are numbered.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace clearance {

class StreamGaps {
 public:
  // `kind` and `stream` name it: "batches" and "of source 'arm'". A number that is not larger means
  // that the sender was started again. 0 stands for no number.
  void note(const std::string& kind, const std::string& stream, std::uint64_t number);

  // Sentences about streams that begin after their first sample, and about the number of samples
  // missing after that.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Stream {
    std::string kind;
    std::uint64_t first = 0, last = 0, missing = 0;
  };
  std::map<std::string, Stream> streams_;
};

}  // namespace clearance
