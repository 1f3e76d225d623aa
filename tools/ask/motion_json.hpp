// A question as a line of JSON, and its answer as another. `clearance-ask --help` has the keys.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// Reads the keys of a motion into `defaults`. Throws BadLine, or nlohmann::json::exception for a
// value of another type.
[[nodiscard]] Question read_question(const nlohmann::json& line, const Question& defaults);

// Names the margin of an answer, by its place in Answer::margins: "0.05", "arm,table=0.05".
[[nodiscard]] std::string margin_text(const Question& question, std::size_t place);

[[nodiscard]] nlohmann::ordered_json answer_line(const Answer& answer, const Scene& scene,
                                                 const Question& question);

}  // namespace clearance
