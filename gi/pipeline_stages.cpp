// The stages, in the order of docs/method.md 2 to 6.
#include <algorithm>
#include <utility>

#include "gi/brute_force.h"
#include "gi/gather.h"
#include "gi/gather_emitters.h"
#include "gi/host_facets.h"
#include "gi/pipeline_impl.h"
#include "gi/scatter.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "gi/writeback.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

constexpr uint32_t kHeldFrames = 8;  ///< of brute force that begins anew, while the mean from before is shown

}  // namespace

void Pipeline::Impl::prepare(uint32_t maxSweeps, const Progress& progress) {
  Redo first = due();
  if (first <= Redo::Voxels) {
    // What the voxels have shown depends on the shaders that made them, too.
    if (std::exchange(shaders, context.shaders.generation()) != context.shaders.generation()) {
      planned.traits.build.reset();
      decide();
    }
    // The new list's products replace the old ones together, once they are lit. Until then the old picture stays.
    Products fresh;
    build(fresh, Redo::Voxels, progress);
    relight(fresh, StagesDue::from(Redo::Emission), maxSweeps, progress);
    now = std::move(fresh);
  } else {
    StagesDue due(made, wanted());
    const auto done = [this](std::initializer_list<Redo> stages) {
      const StageKeys keys = wanted();
      for (const Redo stage : stages) made[stage] = keys[stage];
    };
    if (first <= Redo::Matrix) {
      build(now, first, progress);
      done({Redo::Voxels, Redo::Field, Redo::Matrix});
      due.add(StagesDue::from(Redo::Emission));
    }
    if (due.has(Redo::Materials)) {
      made.forget(Redo::Materials);
      shadeFacets(now, due.has(Redo::Emission), progress);
      done({Redo::Materials});
    }
    fitField(now);
    if (!relights()) return;
    // A mean over frames would begin anew each time; it goes on by itself.
    if (settings.effects.relight == EffectMode::on && !framewise()) due.add(StagesDue::from(Redo::Gather));
    if (first > Redo::Scatter && !due.has(Redo::Solve)) {
      if (now.light->report.settled() && !reflectionsDue()) return;
      due.add(StagesDue::from(Redo::Solve));
    }
    for (const Redo stage : {Redo::Emission, Redo::Gather, Redo::Solve, Redo::Scatter})
      if (due.has(stage)) made.forget(stage);
    relight(now, due, maxSweeps, progress);
  }
  made = wanted();
}

void Pipeline::Impl::shadeFacets(Products& p, bool emitters, const Progress& progress) {
  if (progress && !progress("GI Materials", 0)) throw WorkError("cancelled");
  const Settings& obeyed = planned.settings();
  if (p.facets->surface && p.facets->count > 0 && !p.parts) {
    const auto start = Clock::now();
    p.parts = listParts(context, onDevice, shape(), obeyed);
    endFrame(start, /*setup=*/true);
  }
  const auto start = Clock::now();
  ++revision.materials;
  shadeAnew(context, onDevice, p.gridRecord, obeyed, *p.facets, p.parts);
  if (emitters) {
    p.emitters = listEmitters(context, *p.facets);
    p.emissiveTriangles = listEmissiveTriangles(context, onDevice, planned.traits.materials, *p.facets, p.gridRecord);
  }
  learn(p);
  endFrame(start, /*setup=*/false);
}

void Pipeline::Impl::build(Products& p, Redo first, const Progress& progress) {
  requireMatching(settings);
  const auto start = Clock::now();
  ++revision.build;
  const Settings& obeyed = planned.settings();
  const auto report = [&](const char* stage, float fraction) {
    if (progress && !progress(stage, fraction)) throw WorkError("cancelled");
  };

  // 2, 4. Voxels and facets: which triangles have a piece in which voxel, and which of their sides one facet stands
  // for, with what albedo, normal and emission; in Morton order, with the map back from voxels.
  if (first <= Redo::Voxels) {
    report("GI Voxelization", 0);
    p.facets = makeFacets(context, onDevice, shape(), obeyed, [&] { report("GI Voxelization", 0); });
    p.gridRecord = makeBuffer<Grid>(context, "Grid", Subsystem::Voxels, std::span<const Grid>(&p.facets->grid, 1));
    p.emitters = listEmitters(context, *p.facets);
    p.emissiveTriangles = listEmissiveTriangles(context, onDevice, planned.traits.materials, *p.facets, p.gridRecord);
    p.reference = makeReference(*p.facets);
  }

  // 3. Distance to the nearest solid voxel, for every voxel.
  std::optional<Field> field;
  if (first <= Redo::Field || !fieldFits(p)) {
    report("GI SDF", 0);
    field = plannedField(p);
  }

  // 5. F_ij: share of cosine-weighted directions from facet i that first meet facet j.
  report("GI BuildMatrix", 0);
  // The old matrix is the largest thing there is; a rebuild under a changed list cannot use it, so it goes first,
  // and what the host traces its rays with.
  if (first <= Redo::Voxels) {
    made.forget(Redo::Matrix);
    now.matrix.reset();
    if (now.facets) now.facets->hostTrace.reset();
  }
  p.matrix = planned.on(Effect::matrix)
                 ? buildMatrix(context, *p.facets, field ? *field : *p.field, obeyed,
                               [&](float fraction) { return !progress || progress("GI BuildMatrix", fraction); })
                 : FormFactors{};
  if (field) p.field = std::move(field);
  learn(p);
  endFrame(start, /*setup=*/true);
}

Field Pipeline::Impl::plannedField(const Products& p) {
  const Settings& obeyed = planned.settings();
  return planned.on(Effect::field) ? buildField(context, *p.facets, obeyed) : Field{obeyed.field.method};
}

void Pipeline::Impl::fitField(Products& p) {
  if (fieldFits(p)) return;
  const auto start = Clock::now();
  ++revision.build;
  p.field = plannedField(p);
  endFrame(start, /*setup=*/true);
}

Buffer Pipeline::Impl::makeReference(const FacetList& list) {
  if (!expected || list.count == 0) return {};
  const HostFacets host = hostFacets(context, list);
  std::vector<glm::vec4> h;
  for (size_t i = 0; i < host.count(); ++i) h.emplace_back(glm::vec3(expected(host.position[i], host.normal[i])), 0.0f);
  return makeBuffer<glm::vec4>(context, "oracle's H", Subsystem::Solver, h);
}

void Pipeline::Impl::relight(Products& p, StagesDue due, uint32_t maxSweeps, const Progress& progress) {
  const auto start = Clock::now();
  ++revision.light;
  // A new list has no light yet: if it were given up now it would stay black.
  const bool mayEnd = p.light.has_value();
  const char* stage = "GI Gather";  // that runs
  const auto goesOn = [&] { return !progress || progress(stage, 0) || !mayEnd; };
  // Between steps that may take a second each on a CPU device.
  const auto breathe = [&] {
    if (!goesOn()) throw WorkError("cancelled");
  };
  if (due.has(Redo::Gather) || !p.light) place(context, planned.on(Effect::sky) ? sky : Sky{}, skyOnDevice);
  if (!lit()) return darken(p);
  // The other method's light lacks what this one keeps, and has what this one does not need. By brute force so has
  // that of facets with an M for those without, whose rays are traced anew in any case.
  const auto misfits = [&] { return static_cast<bool>(p.light->emitted) != p.facets->hasEmission; };
  const bool other =
      p.light && (static_cast<bool>(p.light->frameMean.next) != framewise() || (framewise() && misfits()));
  if (!p.light || !*p.light || other) {
    planned.traits.light.noise.reset();
    decide();
    p.light = makeLighting(context, *p.facets, planned.settings());
    due.add(StagesDue::from(Redo::Emission));
  } else if (misfits()) {
    fitEmitted(context, *p.facets, *p.light);
    due.add(Redo::Emission);
  }
  // What lies outside passes on what its materials make of it.
  if (p.facets->outer && (due.has(Redo::Materials) || due.has(Redo::Emission))) due.add(Redo::Gather);
  // Only stages that run are told: their times foretell those of the next edit.
  if (!due.has(Redo::Emission) && !due.has(Redo::Gather)) stage = due.has(Redo::Solve) ? "GI Solve" : "GI Scatter";
  breathe();
  if (due.has(Redo::Emission) && !framewise())
    gatherEmitters(context, *p.facets, *p.matrix, {&*p.emitters, &*p.field}, planned.settings(), *p.light);
  breathe();
  if (due.has(Redo::Gather)) {
    Frame frame = context.begin(frameIndex);
    gather(frame, onDevice, *shadows, *p.facets, *p.field, *p.light, planned.settings());
    lightOuter(frame, onDevice, *p.facets, *p.emitters, *p.field, skyOnDevice);
    if (!framewise()) gatherSky(frame, *p.matrix, binsOf(p.facets->outer, skyOnDevice), *p.light);
    frame.submitAndWait();
    breathe();
  }
  if (due.has(Redo::Solve)) {
    stage = "GI Solve";
    breathe();
    useReflections(*p.light, p.facets->count);
    const bool restarts = due.has(Redo::Materials) || due.has(Redo::Emission) || due.has(Redo::Gather);
    solveFor(p, restarts, maxSweeps, progress, goesOn);
    solvedFrame = frameIndex;
  }
  stage = "GI Scatter";
  goesOn();  // whatever it says: this is soon done, and the light with it
  showSolved(p);
  endFrame(start, /*setup=*/false);
  ++frameIndex;
}

void Pipeline::Impl::showSolved(Products& p) {
  if (!p.light->frameMean.held) scatterInto(p);
  learn(p);
  if (flipsBlur(p.light->report)) scatterInto(p);
}

void Pipeline::Impl::solveFor(Products& p, bool restarts, uint32_t maxSweeps, const Progress& progress,
                              const std::function<bool()>& goesOn) {
  const Settings& obeyed = planned.settings();
  if (!framewise()) {
    solve(context, *p.facets, *p.matrix, *p.light, obeyed, maxSweeps != 0 ? maxSweeps : obeyed.solver.maxSweeps,
          maxSweeps == 0 ? goesOn : std::function<bool()>());  // few sweeps are done before anybody asks
    return;
  }
  const bool byFrames = maxSweeps != 0;
  if (restarts && byFrames) hold(*p.light);
  bruteForce(context, *p.facets, *p.field, skyOnDevice, *p.light, obeyed, byFrames ? 1 : obeyed.solver.frames, restarts,
             [&](float fraction) { return !progress || progress("GI BruteForce", fraction); });
  FrameMean& mean = p.light->frameMean;
  if (mean.held && (++mean.heldFor >= kHeldFrames || !byFrames || p.light->report.settled())) {
    mean.held = Buffer();
    mean.heldEmitted = Buffer();
  }
}

void Pipeline::Impl::hold(Lighting& light) {
  FrameMean& mean = light.frameMean;
  if (mean.held || light.report.frames < kHeldFrames) return;
  Frame frame = context.begin();
  const auto copied = [&](const Buffer& from) {
    Buffer to(context.device, "shown while frames begin anew", Subsystem::Solver, from.bytes);
    frame.pass("GI BruteForce").copy(from, to, from.bytes);
    return to;
  };
  Buffer h = copied(light.shaded()), emitted = light.shadedEmitted() ? copied(light.shadedEmitted()) : Buffer();
  frame.submit();
  mean.held = std::move(h);
  mean.heldEmitted = std::move(emitted);
  mean.heldFor = 0;
}

bool Pipeline::Impl::reflectionsDue() const {
  if (!now.light || !now.light->writeback.report || !relights()) return false;
  const std::shared_ptr<WritebackReport> report = now.light->writeback.report;
  if (report->taken) return false;
  if (report->pending) context.finish();  // the frame, unless it is still being recorded
  return !report->pending && report->change > settings.solver.tolerance * now.light->report.meanH;
}

void Pipeline::Impl::useReflections(Lighting& light, uint32_t facets) {
  fitWriteback(context, facets, planned.settings(), light.writeback);
  if (light.writeback.report && !light.writeback.report->taken) takeDrawn(light.writeback);
}

void Pipeline::Impl::scatterInto(Products& p) {
  Frame frame = context.begin(frameIndex);
  const bool mayBlur =
      settings.effects.blur == EffectMode::automatic && settings.sample.gpu.filter_ == SampleFilter::blur;
  scatter(frame, *p.facets, *p.matrix, *p.light, planned.settings(), /*watchBlur=*/mayBlur);
  frame.submitAndWait();
}

bool Pipeline::Impl::flipsBlur(const SolveReport& report) {
  if (!report.blurChange) return false;
  std::optional<float>& noise = planned.traits.light.noise;
  // In the dark it changes nothing, whatever it may do to the next light.
  if (report.largestH > 0 || !noise) noise = report.largestH > 0 ? *report.blurChange / report.largestH : 0;
  const bool was = planned.on(Effect::blur);
  decide();
  return planned.on(Effect::blur) != was;
}

void Pipeline::Impl::darken(Products& p) {
  p.light.emplace();
  p.light->report.converged = true;
  learn(p);
}

}  // namespace irad
