// The whole method, stage after stage, for one scene: what is due is redone, the rest is kept.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gi/settings.h"
#include "gi/views/views.h"

namespace irad {

class Buffer;
class Context;
class Frame;
class SceneOnDevice;
struct Camera;
struct EffectPlan;
struct FacetList;
struct Field;
struct Finding;
struct FormFactors;
struct Light;
struct Lighting;
struct MaterialEdit;
struct RegionBox;
struct Scene;
struct SavedFrames;
struct SceneTraits;
struct ShadowMaps;
struct Sky;
struct SkyImage;
struct Targets;

/// Called between steps with the running stage's name and its share done; returns false to cancel.
using Progress = std::function<bool(const char* stage, float fraction)>;

/// How often a pipeline has begun to make its products anew.
struct Revision {
  uint64_t build = 0;  ///< facets, field, matrix
  uint64_t light = 0;
  uint64_t materials = 0;  ///< what they give the facets of one build
  bool operator==(const Revision&) const = default;
};

/// What it took until pictures and light agreed on the reflections that are written back.
struct WritebackRounds {
  static constexpr uint32_t kMost = 200;
  static constexpr uint32_t kPatience = 20;  ///< rounds in which the changes of W are to halve at least
  uint32_t rounds = 0;                       ///< pictures; 0: nothing is written back
  bool settled = false;                      ///< the last one changed W by no more than H is known to
};

/// The indirect irradiance H, W/m^2, at a local point of a surface with this normal, where it is known (check scenes).
using ExpectedIrradiance = std::function<glm::dvec3(const glm::dvec3& position, const glm::dvec3& normal)>;

struct PictureOptions {
  const Buffer* range = nullptr;  ///< ViewInputs::range
  /// Where the last picture in these targets was drawn from the same place, and nothing has changed since, its surfaces
  /// with their light are not drawn again. The picture is the same, bit for bit; what it takes is not measured.
  bool shareSurfaces = false;
};

class Pipeline {
 public:
  Pipeline(Context& context, Scene scene, const Settings& settings, ExpectedIrradiance expected = {});
  ~Pipeline();

  const Scene& scene() const;
  SceneOnDevice& device();
  const Settings& settings() const;
  /// The settings that the stages have: with the effect plan's decisions.
  const Settings& obeyed() const;
  /// Which effects run, which do not, and why, as of now. `redraw`: SceneTraits::redraw.
  EffectPlan plan(std::optional<bool> redraw = {}) const;
  /// What the plan was decided on.
  const SceneTraits& traits() const;
  /// Takes new settings; returns the first stage that the next prepare() will redo: Redo::Nothing where the settings,
  /// or what has come of them, are those that the products were made with.
  Redo set(const Settings& settings);
  /// What set() would return, without taking them.
  Redo due(const Settings& settings) const;
  /// Takes other lights, of any number, and draws their shadow maps; gather, solve and scatter follow at the next
  /// prepare(). UsageError names what is wrong with a light, DeviceError that there is no memory for its shadow map:
  /// then the old lights stay.
  void setLights(std::vector<Light> lights);
  /// Takes other edits of materials, in place of those that the scene has: the facets' rho and M, what light these
  /// need, and solve follow at the next prepare(), or all of it where an edit moves what an alpha mask cuts out.
  /// UsageError names what is wrong with a material: then the old edits stay.
  void setMaterials(std::vector<MaterialEdit> edits);
  /// The first stage that would be due with these.
  Redo due(const std::vector<MaterialEdit>& edits) const;
  /// Takes another box for the scene's (Scene::region), or none: with scene.region=auto all is built anew.
  void setRegion(const std::optional<RegionBox>& box);
  /// Takes another reading of the scene, such as its file after an edit, with other lights, edits of materials, region,
  /// cameras and bookmarks. False, and `scene` and this stay as they are, where its file's surfaces or materials differ
  /// by their content: that takes another pipeline. Throws what setLights() throws.
  bool adopt(Scene& scene);
  /// Lights were edited in device().lightValues: shadows, gather, solve, scatter follow.
  void lightsChanged();

  /// Takes a picture for sky.source = image, or none (null), in place of the scene's.
  void setSky(std::shared_ptr<const SkyImage> image);
  /// The sky that the settings ask for. Its sun is the last of device().lightValues.
  const Sky& sky() const;

  /// H and B become 0: the next prepare() solves from the dark.
  void darken();

  /// `from` and the stages that come of it run again at the next prepare(): repeated measurements.
  void invalidate(Redo from);

  /// Runs what is dirty up to the scatter: blocking. When it throws or is cancelled pictures are drawn from the old
  /// state, and the next prepare() does the rest. Of the old state a rebuild of the facets gives up the matrix, for its
  /// memory (its views are empty then); a relight that fails leaves the light as far as it came. `maxSweeps` 0:
  /// settings.solver.maxSweeps; by brute force settings.solver.frames, and with any other number one frame.
  void prepare(const Progress& progress = {}, uint32_t maxSweeps = 0);
  /// True when nothing is dirty and the solver is done: its bound is below the tolerance, brute force has its frames,
  /// or the watch stopped it.
  bool asleep() const;
  /// True when nothing is due: what the pipeline holds was made with its settings. The solver may have sweeps left.
  bool current() const;
  /// Calls `draw` while the light is the one that a headless run solves: from the dark, in one go, to the tolerance.
  /// (The window's own depends on what was shown before, within the tolerance: it starts warm, and stops at another
  /// sweep.) Nothing is written back yet: where it is to be, `draw` begins with settleReflections(). Afterwards the
  /// light from before is back. Must be current(). Blocking.
  void solvedAfresh(const Progress& progress, const std::function<void()>& draw);
  /// Pictures show these H and B, a value per facet, in place of those solved, until light is solved again; none: those
  /// that are there. There must be light, and the pipeline current().
  void showLight(std::span<const glm::vec4> indirect, std::span<const glm::vec4> radiosity);
  /// Goes on with the frames of brute force of an earlier run of the same scene and settings, in place of those that
  /// have been prepared (restoreFrames); the next prepare() finds out whether there are enough. Must be current().
  void goOn(const SavedFrames& frames);
  /// What the numerical watch has to say about the light as it is, and which lights cast no shadow.
  std::vector<Finding> findings() const;
  /// Those of scene().lights that shine but cast no shadow: the device has not the layers for their maps.
  std::vector<uint32_t> lightsWithoutShadow() const;

  /// One picture of `view` into targets.linear and targets.display.
  void render(Frame& frame, const Camera& camera, View view, Targets& targets, const PictureOptions& options = {});

  /// Where reflections are written back: draws the camera's picture and relights, in turn, until what the picture
  /// writes back changes no more (docs/method.md 8), or does not settle, or kMost times. Blocking. Must be current().
  WritebackRounds settleReflections(const Camera& camera, Targets& targets, const Progress& progress = {});

  /// The picture that the views of group "Reference" show and compare with: radiance, top row first. `of`: what the
  /// view `error` compares with it. No pixels: none.
  void setReference(glm::uvec2 size, std::span<const glm::vec4> pixels, View of = VIEW_LIT);
  bool hasReference() const;
  /// Whether it was given what the irradiance should be, for VIEW_REFERENCE.
  bool knowsIrradiance() const;

  /// Whatever was read from the products before these grew is stale.
  Revision revision() const;
  // In a scene that does not call for them field, matrix and light are empty: false, without a buffer. So is the matrix
  // with solver.method = brute_force.
  const FacetList& facets() const;
  const Field& field() const;
  const FormFactors& matrix() const;  ///< after a prepare() that succeeded
  const Lighting& lighting() const;
  const ShadowMaps& shadows() const;

 private:
  struct Impl;
  Impl& changed();  ///< for whatever changes what pictures are drawn from
  std::unique_ptr<Impl> impl_;
};

}  // namespace irad
