// What steps in where a run asks for too much: capacities, memory, divergence.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/watch.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

constexpr glm::uvec2 kGuardPicture(64, 64);

void capacityCase(CheckRun& run) {
  Settings settings = run.small();
  const auto pipeline = run.prepare(mixedRoom(), settings);
  const CheckPicture before = run.picture(*pipeline, pipeline->scene().cameras.at(0), VIEW_LIT, kGuardPicture);

  // Nothing is dropped: every ray is in its row, or counted as what became of it.
  uint64_t hits = 0;
  forEachRow(run.context, pipeline->matrix(), [&](uint32_t, const HostRow& row) {
    hits += std::accumulate(row.hits.begin(), row.hits.end(), uint64_t{0});
  });
  const MatrixStats& stats = pipeline->matrix().stats;
  run.near("hits in rows / hits of rays", static_cast<double>(hits) / static_cast<double>(stats.hits), 1, 0);

  const auto refused = [&](const std::function<void()>& work, const char* word) {
    try {
      work();
      return false;
    } catch (const Error& error) {
      return std::string_view(error.what()).find(word) != std::string_view::npos;
    }
  };
  // More hits per row than a csr entry can count beside its column.
  settings.matrix.format = MatrixFormat::csr;
  settings.matrix.gpu.rays = 1u << 20;
  run.require(
      "row capacity exceeded: an error that names matrix.rays",
      refused([&] { buildMatrix(run.context, pipeline->facets(), pipeline->field(), settings); }, "matrix.rays"));
  // Padded rows larger than any memory.
  settings.matrix.format = MatrixFormat::padded;
  settings.matrix.gpu.rays =
      static_cast<uint32_t>(run.context.device.memory().budget() / (8ull * pipeline->facets().count)) + 1;
  run.require("padded matrix beyond memory: an error that names csr",
              refused([&] { buildMatrix(run.context, pipeline->facets(), pipeline->field(), settings); }, "csr"));
  // The list's capacity: an axis of more voxels than coordinates can say.
  settings = run.small();
  settings.voxel.resolution = 1023;
  run.require("grid too fine: an error that names voxel.resolution", refused(
                                                                         [&] {
                                                                           pipeline->set(settings);
                                                                           pipeline->prepare();
                                                                         },
                                                                         "voxel.resolution"));
  pipeline->set(run.small());
  pipeline->prepare();
  run.none("pixels that the refusals changed",
           countDiffering(before, run.picture(*pipeline, pipeline->scene().cameras.at(0), VIEW_LIT, kGuardPicture)));

  // A tiny budget: refused by name, or enough; the same bits where it is enough.
  uint32_t refusals = 0, pictures = 0;
  uint64_t differing = 0;
  for (const uint64_t mib : {1, 4, 16, 256}) {
    DeviceOptions options = run.sameDevice();
    options.memoryBudget = mib << 20;
    Apart apart(options);
    CheckRun there(apart.context, run.settings, run.options);
    const bool no = refused(
        [&] {
          const auto made = there.prepare(mixedRoom(), run.small());
          differing +=
              countDiffering(before, there.picture(*made, made->scene().cameras.at(0), VIEW_LIT, kGuardPicture));
          ++pictures;
        },
        "needs");
    refusals += no;
  }
  run.near("tiny budgets: refused in words, or drawn", refusals + pictures, 4, 0);
  run.atLeast("tiny budgets refused", refusals, 1, /*ideal=*/2);
  run.none("pixels that a budget changes", differing);
}

Scene brightRoom() {
  return furnaceBox(0.9f);
}

void divergenceCase(CheckRun& run) {
  for (const float lambda : {2.0f, 1.15f}) {
    Settings settings = run.settings;
    settings.solver.gpu.lambda = 1;
    settings.matrix.gpu.rays = 64;  // all meet the same B
    const auto pipeline = run.prepare(brightRoom(), settings);
    settings.solver.gpu.lambda = lambda;  // row gain .9 lambda
    pipeline->set(settings);
    pipeline->prepare();
    const SolveReport& report = pipeline->lighting().report;
    const std::string at = fmt::format(" at gain {:.4g}", 0.9 * lambda);
    run.require("diverging is reported" + at, report.diverging && !report.converged);
    run.atMost("sweeps until it is stopped" + at, report.sweeps, 20);
    run.none("B not finite" + at, countNonFinite(run.read(*pipeline, pipeline->lighting().radiosity)));
    const std::vector<Finding> said = pipeline->findings();
    run.require("said in words" + at, std::any_of(said.begin(), said.end(), [](const Finding& f) {
                  return f.text.find("diverg") != std::string::npos;
                }));
    run.near("light that stays, B (1 - rho)" + at,
             spread(run.read(*pipeline, pipeline->lighting().radiosity)).mean * 0.1, 1, 0.02);
  }
}

}  // namespace

std::vector<CheckCase> guardCases() {
  return {
      {"capacity", "rows, grid and memory budget exceeded", "reported, nothing dropped", "exact", capacityCase,
       mixedRoom},
      {"divergence", "lambda such that the spectral radius is 1.8 and 1.035", "stopped within 20 sweeps, said in words",
       "finite", divergenceCase, brightRoom},
  };
}

}  // namespace irad
