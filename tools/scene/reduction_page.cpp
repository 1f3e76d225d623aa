// Writes a reduction as a page of Markdown.
#include <fmt/format.h>

#include <optional>

#include "core/enclosing_polyhedron.hpp"
#include "tools/scene/reduction.hpp"

namespace clearance {
namespace {

std::string command(const ReductionOptions& options, const std::string& svg) {
  std::string text = "clearance-scene reduce";
  for (const std::filesystem::path& file : options.files) {
    text += " " + file.filename().string();
  }
  text += " --distance";
  for (const double distance : options.distances) text += fmt::format(" {:g}", distance);
  return text + fmt::format(" --speed {:g} --plot {}", options.speed, svg);
}

std::string models(const Reduction& body) {
  std::string text =
      "| model | facets | error, mm | ns tracked | ns cold |\n|---|---|---|---|---|\n";
  for (const ReducedModel& model : body.models) {
    text += fmt::format("| {} | {} | {:.2f} | {:.0f} | {:.0f} |\n", model.name,
                        model.facets() > 0 ? fmt::format("{}", model.facets()) : "-",
                        1e3 * rounded_up_error(model.error), model.time->tracked, model.time->cold);
  }
  return text;
}

std::string cost(const std::vector<Level>& levels, std::size_t i, const Watching& watching) {
  const auto made = watch_cost(levels[i], watching);
  return made ? fmt::format("{:.3g}", 1e-3 * made->ns_per_s) : "in every tick";
}

// The model that the broad phase uses as the hull of an object of several parts.
std::optional<std::size_t> bounding_hull_of(const Reduction& body) {
  for (std::size_t i = 0; i < body.models.size(); ++i) {
    const ReducedModel& model = body.models[i];
    if (model.name == name(ModelKind::kPolyhedron) && model.facets() == EnclosingOptions().facets) {
      return i;
    }
  }
  return std::nullopt;
}

// The finest model comes last: the hull, or the most parts.
std::string cheapest_rows(const Reduction& body, const ReductionOptions& options) {
  const std::vector<Level> levels = levels_of(body);
  const auto hull = bounding_hull_of(body);
  std::string text;
  for (const double distance : options.distances) {
    const Watching watching{distance, options.speed};
    const auto best = cheapest(levels, watching);
    text += fmt::format("| {} | {:g} | {} | {} | {} | {} |\n", body.name, distance,
                        best ? label_of(body.models[*best]) : "none",
                        best ? cost(levels, *best, watching) : "in every tick",
                        hull ? cost(levels, *hull, watching) : "-",
                        cost(levels, levels.size() - 1, watching));
  }
  return text;
}

std::string ranges(const Reduction& body, const ReductionOptions& options) {
  std::string text;
  for (const CheapestFrom& from : cheapest_by_distance(levels_of(body), options.speed)) {
    text += fmt::format("{}{} from {:.3g} m", text.empty() ? "" : ", ",
                        label_of(body.models[from.level]), from.distance);
  }
  return fmt::format("- {}: {}\n", body.name, text);
}

}  // namespace

std::string reduction_page(const std::vector<Reduction>& bodies, const ReductionOptions& options,
                           const std::string& svg) {
  std::string text = fmt::format(
      "# Models of links: error against time\n\nMade by `{}`. Times are ns a query against a box, "
      "the least of 15 rounds: trust their ratios.\n\n![error against time]({})\n\n"
      "An error is certified: no point of the model's surface, or of the parts', is farther than "
      "this from the mesh; what a mesh encloses counts as its own. Models of one body hold the "
      "hull, "
      "so that theirs is at most the sum of both errors. Of parts, all are queried.\n\n"
      "## Where finer stops paying\n\nThe broad phase leaves a pair alone until both objects have "
      "moved by what a model proves above the level that matters. At distance D beyond that, a "
      "model of error e is looked at V / (D - e - u) times a second, V being how far both objects "
      "come in a second, and u the nine ticks' motion that the broad phase takes off. Times the "
      "cost of a cold query, that is what each model costs. In the picture the cheapest model at D "
      "is the one that a dashed line touches: along it the cost is the same, below and left of it "
      "less. It holds for one model alone; the sphere, which costs a few ns, is tried before any "
      "other.\n\nV = {:g} m/s, us of queries a second:\n\n"
      "| link | D, m | cheapest | it costs | 32 facets | the finest |\n|---|---|---|---|---|---|\n",
      command(options, svg), svg, options.speed);
  for (const Reduction& body : bodies) text += cheapest_rows(body, options);
  text += "\nThe cheapest at each distance:\n\n";
  for (const Reduction& body : bodies) text += ranges(body, options);
  for (const Reduction& body : bodies) {
    text += fmt::format("\n## {}\n\nHull of {} facets, {} vertices.\n\n{}", body.name, body.facets,
                        body.vertices, models(body));
  }
  return text;
}

}  // namespace clearance
