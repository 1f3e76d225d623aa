// An answer with the names of objects and zones in the place of their indices, for clients.
#pragma once

#include "config/scene/scene.hpp"
#include "monitor/interface/motion_question.hpp"

namespace clearance {

// Fills in all that the answer to this question about this scene says. The rest of the result stays
// as it is.
void name_answer(const Answer& answer, const Question& question, const Scene& scene,
                 QuestionResult& result);

}  // namespace clearance
