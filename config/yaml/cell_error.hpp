// One mistake in a cell file.
#pragma once

#include <string>

namespace clearance {

// `text` reads "FILE:LINE:COLUMN: what was found, what was expected".
struct CellError {
  std::string text;
};

}  // namespace clearance
