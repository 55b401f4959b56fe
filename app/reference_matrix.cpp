// `irad reference --of matrix`: the matrix, solved in double precision.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/device_session.h"
#include "app/interrupts.h"
#include "app/reference_task.h"
#include "gi/check/exact_solve.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/targets.h"

namespace irad::app::reference {
namespace fs = std::filesystem;
namespace {

constexpr double kExactTolerance = 1e-12;

glm::dvec3 meanOf(const std::vector<glm::vec4>& pixels) {
  glm::dvec3 sum(0);
  for (const glm::vec4& p : pixels) sum += glm::dvec3(p);
  return sum / static_cast<double>(pixels.size());
}

/// What is seen of each bounce, as layers; and its share of the picture, printed. There is exact light to be seen.
Json drawBounces(const Task& task, DeviceSession& session, Pipeline& pipeline, const Camera& camera,
                 const ExactLight& exact, Targets& targets, std::vector<PictureLayer>& layers) {
  const glm::dvec3 lit = meanOf(drawn(session, pipeline, camera, VIEW_LIT, targets));
  std::vector<glm::dvec3> means;
  for (uint32_t k = 0; k < task.bounces; ++k) {
    std::vector<glm::vec4> h;
    for (const glm::dvec3& v : exact.bounces[k]) h.emplace_back(glm::vec3(v), 0.0f);
    if (k == 1) {
      // Only what has come straight may be replaced by what pixels see of emitters.
      Settings lookedUp = session.settings;
      lookedUp.sample.emitters = EmitterLookup::facets;
      pipeline.set(lookedUp);
    }
    pipeline.showLight(h, {});
    std::vector<glm::vec4> seen = drawn(session, pipeline, camera, VIEW_INDIRECT, targets);
    if (k == 0) {
      const std::vector<glm::vec4> straight = drawn(session, pipeline, camera, VIEW_NO_GI, targets);
      for (size_t i = 0; i < seen.size(); ++i) seen[i] += glm::vec4(glm::vec3(straight[i]), 0);
    }
    means.push_back(meanOf(seen));
    addLayer(layers, bounceName(k), std::move(seen), std::nullopt);
  }
  pipeline.set(session.settings);
  return tellBounces(lit, means, {});
}

}  // namespace

void solveMatrix(const Arguments& arguments, const Task& task, DeviceSession& session, Scene scene,
                 const Camera& camera) {
  if (session.settings.solver.method != SolverMethod::matrix)
    throw UsageError("--of matrix: solver.method = brute_force has no matrix");
  if (session.settings.effects.matrix == EffectMode::automatic) session.settings.effects.matrix = EffectMode::on;
  const auto folder = beginFiles(task);  // goes again where the work fails
  const auto start = std::chrono::steady_clock::now();
  const StopOnSignal interrupts;
  Pipeline pipeline(*session.context, std::move(scene), session.settings);
  session.prepare(pipeline);
  if (!pipeline.matrix() || !pipeline.lighting())
    throw UsageError("--of matrix: there is no matrix, or no light that it could carry");
  const SolveReport solved = pipeline.lighting().report;
  const ExactLight exact = solveExactly(
      *session.context, pipeline, kExactTolerance,
      [&](float done) { return session.progress("solving in double precision", done) && !interrupts.came(); },
      task.bounces);
  const std::vector<glm::vec3> h = perFacet(*session.context, pipeline.facets(), pipeline.lighting().indirect);
  double largest = 0;
  for (size_t i = 0; i < h.size(); ++i)
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(double{h[i][c]} - exact.indirect[i][c]));
  std::vector<glm::vec4> indirect, radiosity;
  for (size_t i = 0; i < h.size(); ++i) {
    indirect.emplace_back(glm::vec3(exact.indirect[i]), 0.0f);
    radiosity.emplace_back(glm::vec3(exact.radiosity[i]), 0.0f);
  }
  pipeline.showLight(indirect, radiosity);
  Targets targets(*session.context, task.size);
  std::vector<PictureLayer> layers;
  for (const std::string& name : task.layers)
    addLayer(layers, name, drawn(session, pipeline, camera, viewOf(name), targets), std::nullopt);
  Json bounces;
  if (task.bounces > 0) bounces = drawBounces(task, session, pipeline, camera, exact, targets, layers);
  std::vector<fs::path> written = writeLayers(task.stem, task.size, layers, subjectOf(task, camera));
  if (arguments.facets) written.push_back(writePerFacet<double>(task.beside(".irradiance.npy"), exact.indirect));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Json truth{{"of", task.of},        {"layers", task.layers},
             {"complete", true},     {"sweeps", exact.sweeps},
             {"seconds", seconds},   {"mean_irradiance", exact.meanH},
             {"bound", exact.bound}, {"largest_error_of_the_solver", largest}};
  if (task.bounces > 0) truth["bounces"] = bounces;
  session.progress.finish();
  print("facets      {}\n", h.size());
  print("solve       {} sweeps in double precision, error at most {:.3g} W/m^2 of mean H {:.6g}\n", exact.sweeps,
        exact.bound, exact.meanH);
  print("solver      was off by {:.3g} W/m^2 at most, its bound {:.3g}\n", largest, solved.bound);
  finishFiles(task, arguments, session.manifest("reference", pipeline), camera, truth, std::move(written));
  session.checkNumbers(pipeline);
  session.checkValidation();
}

}  // namespace irad::app::reference
