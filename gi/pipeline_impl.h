// What a pipeline holds and does behind its interface (pipeline.h), for the files pipeline*.cpp alone.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "gi/pipeline.h"
#include "gi/plan.h"
#include "gi/products.h"
#include "gi/scene_shape.h"
#include "gi/shadow_needs.h"
#include "gi/sky.h"
#include "gi/stage_keys.h"

namespace irad {

struct Pipeline::Impl {
  Impl(Context& context, Scene scene, const Settings& settings, ExpectedIrradiance expected);

  /// A number that no other state of any pipeline has.
  static uint64_t newState();

  Context& context;
  Scene scene;
  ExpectedIrradiance expected;
  Settings settings;  ///< the user's; stages get planned.settings()
  Planned planned;
  SceneOnDevice onDevice;
  Buffer camera;
  uint64_t frameIndex = 0;
  Revision revision;
  uint64_t state = newState();  ///< of all that pictures are drawn from
  uint64_t solvedFrame = 0;     ///< of the last solve
  uint64_t shaders = 0;         ///< ShaderLibrary::generation() of the last build

  // What there is to be made, and what was made, by content. Shadow maps are not the product of a stage, but have a key
  // like one.
  SurfaceContent surfaces;
  SceneContent content;
  std::optional<std::vector<SamePlace>> repeats;  ///< once something has been built
  StageKeys made;
  uint64_t shadowsMade = 0, shadowsWanted = 0;

  Products now;  ///< what pictures are drawn from
  std::optional<ShadowMaps> shadows;
  Image picture;  ///< the reference picture
  View pictureOf = VIEW_LIT;

  Sky sky;                        ///< that the settings ask for
  std::optional<SkySun> sunUsed;  ///< that is among the device's lights
  SkyOnDevice skyOnDevice;        ///< that the light is made with; none where the plan has it off

  // ---- What settings and scene ask for (pipeline_wanted.cpp) ----

  /// The first stage that the next prepare() has to run. Those that come of it follow.
  Redo due() const { return firstDifference(made, wanted()); }
  StageKeys wanted() const { return stageKeys(content, planned.settings()); }
  bool shadowsDue() const { return shadowsMade != shadowsWanted; }

  /// Decides anew on what is known by now; what that changes becomes due.
  void decide();
  ShadowNeeds shadowNeeds() const;
  /// The key of the shadow maps that these lights need.
  uint64_t shadowKey(std::span<const GpuLight> lights) const;
  void useMaterials();
  void lookAtSurfaces(const std::vector<Material>& of, SceneContent& in) const;
  void lookAtLights(std::span<const GpuLight> lights);
  void lookAtSky(std::span<const Light> lights);
  /// regionOrWhole(), which may look at every triangle, but where settings leave the region as it is.
  SceneRegion regionWith(const Settings& wanted) const;
  /// UsageError where the box that settings or scene ask for holds nothing of it, of which the traits say nothing.
  SceneShape shape();
  static uint64_t regionKey(const SceneRegion& of) { return Digest().add(of.lo).add(of.hi).value(); }
  void lookAtRegion(const SceneRegion& now);
  /// Settings or sky have changed.
  void lookAgain();
  /// The sun of the sky, where the sky may shine.
  std::optional<SkySun> skySun() const;
  /// These lights, and behind them the sun of the sky.
  std::vector<GpuLight> withSun(std::vector<Light> lights) const;
  /// Where that has changed it becomes one of the device's lights. Returns whether it has.
  bool useSun();
  void redrawShadows();

  void learn(const Products& p) { planned.traits.build = buildTraits(p); }

  /// The light's state, which changes from frame to frame.
  LightState lightState() const;

  bool lit() const { return planned.plan().indirectLight(); }
  /// H by the rays of frames, without a matrix.
  bool framewise() const { return planned.on(Effect::bruteForce); }
  bool relights() const { return settings.effects.relight != EffectMode::off; }

  using Clock = std::chrono::steady_clock;
  /// The timings of a frame that began at `start` are complete (Timings::endFrame).
  void endFrame(Clock::time_point start, bool setup) {
    const std::chrono::duration<double, std::milli> took = Clock::now() - start;
    context.timings.endFrame(frameIndex, setup, took.count());
  }

  // ---- The stages (pipeline_stages.cpp) ----

  void prepare(uint32_t maxSweeps, const Progress& progress);

  /// What materials give the facets of voxels that stay: rho and M, with what is listed of the emitters where these are
  /// others.
  void shadeFacets(Products& p, bool emitters, const Progress& progress);

  /// Everything from the geometry to the matrix: the thesis's "Init" set. `first`: the stage to start from.
  void build(Products& p, Redo first, const Progress& progress);

  /// Whether there is a field where the plan has it on, and none where it has it off. No stage's key says so, since a
  /// field that is only kept or dropped causes nothing to be made again; so the product itself is asked.
  bool fieldFits(const Products& p) const { return planned.on(Effect::field) == static_cast<bool>(*p.field); }
  Field plannedField(const Products& p);
  /// Rays may come to need the field of the same voxels, or stop needing it.
  void fitField(Products& p);

  Buffer makeReference(const FacetList& list);

  /// The thesis's "per-frame" set, with the lights as they are: D, after F M where that is due, then H <- F B and B <-
  /// M + rho (D + H) until the error bound holds, then H to where shading reads it.
  void relight(Products& p, StagesDue due, uint32_t maxSweeps, const Progress& progress);

  /// To where shading reads it.
  void showSolved(Products& p);

  /// `restarts`: frames of brute force begin anew. `maxSweeps` 0: as many as it takes; else one frame of brute force,
  /// which costs as much as a matrix.
  void solveFor(Products& p, bool restarts, uint32_t maxSweeps, const Progress& progress,
                const std::function<bool()>& goesOn);

  /// A mean over frames begins in the dark, and with noise. What was shown before is shown on until it is better, which
  /// is no part of the mean. (While a light is dragged each frame begins anew, and is shown after the first few.)
  void hold(Lighting& light);

  /// Whether the picture that was drawn last has changed what is written back by more than H is known to.
  bool reflectionsDue() const;
  /// Light is solved with what the last picture has written back.
  void useReflections(Lighting& light, uint32_t facets);

  void scatterInto(Products& p);

  /// Decides by how much the blur changes the light as it is: where that does not show, H is shown without it. Returns
  /// whether that puts the blur on or off.
  bool flipsBlur(const SolveReport& report);

  /// No light, or nothing that shows it: H is 0 without being stored.
  void darken(Products& p);

  // ---- Pictures (pipeline_pictures.cpp) ----

  /// Of what surfaces are drawn from.
  uint64_t surfacesKey(const GpuCamera& from) const;
};

}  // namespace irad
