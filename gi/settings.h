// Every setting once: a plain struct and one visit() that gives name, range, unit, help, and what must be redone when it
// changes. Widgets, --set, JSON, presets, `irad settings`, reset buttons and the round-trip test all come from visit().
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shaders/shared/color_map.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/view.h"

namespace irad {

enum class VoxelMethod : uint32_t { raster, conservative };
enum class NormalEncoding : uint32_t { axis6, axis26, oct8, oct16 };
enum class FieldMethod : uint32_t { chebyshev, jfa };
enum class MatrixFormat : uint32_t { padded, csr };
enum class Traversal : uint32_t { dda, sdf };
enum class HitRule : uint32_t { thesis, robust };
enum class SampleFilter : uint32_t { nearest, linear, blur };
enum class SpecularMode : uint32_t { off, fragment, compute };
enum class ToneCurve : uint32_t { linear, neutral };
enum class EmitterSampling : uint32_t { off, automatic, on };
/// Who gives a pixel the light that comes straight from emissive faces: the facets around it, or their triangles.
enum class EmitterLookup : uint32_t { facets, pixels };
enum class SolverKernel : uint32_t { automatic, tree, subgroup, row };
/// Who turns triangles into pixels: the graphics pipeline, or compute kernels (shaders/raster).
enum class Rasterizer : uint32_t { automatic, hardware, kernels };
enum class ViewShape : uint32_t { cubes, slice, projection, isosurface, automatic };
enum class Axis : uint32_t { x, y, z, automatic };
enum class RangeMode : uint32_t { standard, automatic, percentile, manual };
enum class ColorMap : uint32_t { violetYellow, heat, grey };
/// Of an effect (gi/plan.h). automatic: where the scene calls for it; on: done though it is not called for; off: not done
/// though it is.
enum class EffectMode : uint32_t { automatic, on, off };

/// The first stage that has to run again when a setting changes; later ones follow. Ordered. (Emission: the first gather
/// from emissive facets, F M of METHOD 6.)
enum class Redo : uint32_t { Voxels, Field, Matrix, Emission, Gather, Solve, Scatter, Shade, Nothing };

/// The names of an enumeration's values, in order. Specialized below visit().
template <class E>
struct EnumNames;

struct Meta {
  const char* name;  ///< "group.member", as --set takes it
  double min = 0, max = 0;
  const char* unit;  ///< "" where there is none
  const char* help;  ///< one sentence
  Redo redo;
  bool logarithmic = false;
  double step = 0;  ///< > 0: only min + k step is allowed
};

struct VoxelSettings {
  uint32_t resolution = 64;  ///< N: voxels along the longest axis
  VoxelMethod method = VoxelMethod::conservative;
  uint32_t facets = 2;
  NormalEncoding normals = NormalEncoding::oct16;
};
struct FieldSettings {
  FieldMethod method = FieldMethod::chebyshev;
};
struct MatrixSettings {
  MatrixFormat format = MatrixFormat::csr;
  MatrixParams gpu{128, HIT_RULE_ROBUST, TRAVERSAL_SDF, 1, 0};
  EmitterSampling emitterSampling = EmitterSampling::automatic;
  uint32_t emitterSamples = 32;  ///< per facet
};
struct GatherSettings {
  uint32_t samples = 4;  ///< shadow lookups per facet and light
};
struct SolverSettings {
  SolverParams gpu{1.0f, 1.0f, 1e-12f};
  float tolerance = 5e-4f;        ///< stop when the error bound is below this share of the largest H
  uint32_t sweepsPerFrame = 4;    ///< interactive; headless runs until the tolerance or maxSweeps
  uint32_t maxSweeps = 1000;
  SolverKernel kernel = SolverKernel::automatic;
};
struct ScatterSettings {
  bool edgeRemoval = false;  ///< T 5.9.1: the volume holds B - lambda E instead of H
};
struct SampleSettings {
  SampleParams gpu{FILTER_BLUR, 1, 1, 0.5f};
  EmitterLookup emitters = EmitterLookup::facets;
  uint32_t emitterRays = 8;  ///< per pixel
};
struct SpecularSettings {
  SpecularMode mode = SpecularMode::compute;
  SpecularParams gpu{4, TRAVERSAL_SDF, 0.6f, 0.15f, 1e-4f, 1};
};
struct LightSettings {
  uint32_t shadowResolution = 2048;  ///< texels per side; point lights use half per cube face
};
struct CameraSettings {
  float exposureEv = 0.0f;
  ShadeParams gpu{1.0f, TONE_NEUTRAL, 1.5f, 3, 1};
};
/// How views are shown; they change no light.
struct ViewSettings {
  ViewShape shape = ViewShape::automatic;
  Axis axis = Axis::automatic;
  float slice = 0.5f;     ///< 0..1 along the axis
  float isovalue = 2.0f;  ///< voxels
  uint32_t jfaPass = 11;  ///< 0: the seeds alone; past the last: the last
  uint32_t light = 0;     ///< index
  uint32_t facet = 0;     ///< index in the facet list; past the last: none
  RangeMode range = RangeMode::standard;
  float low = 0.0f, high = 1.0f;
  float percentile = 99.0f;
  ColorMap colorMap = ColorMap::violetYellow;
};
struct ThesisSettings {
  bool literal = false;  ///< bring back the thesis's plain slips (METHOD, first paragraph)
};

/// Overrides of the effect plan.
struct EffectSettings {
  EffectMode emission{}, sun{}, point{}, spot{}, matrix{}, specular{}, secondFacet{}, field{}, relight{}, alphaTest{},
      normalMap{}, blur{};
  float blurNoise = 2e-3f;  ///< share of the largest H that the blur may change for it to be left out
};

/// How the scene's file is read (LoadOptions).
struct SceneSettings {
  bool lambertian = false, doubleSided = false;
  bool operator==(const SceneSettings&) const = default;
};

struct Settings {
  VoxelSettings voxel;
  FieldSettings field;
  MatrixSettings matrix;
  GatherSettings gather;
  SolverSettings solver;
  ScatterSettings scatter;
  SampleSettings sample;
  SpecularSettings specular;
  LightSettings light;
  CameraSettings camera;
  ViewSettings view;
  ThesisSettings thesis;
  EffectSettings effects;
  Rasterizer rasterizer = Rasterizer::automatic;  ///< device.rasterizer
  SceneSettings scene;
};

template <>
struct EnumNames<VoxelMethod> {
  static constexpr std::array names{"raster", "conservative"};
};
template <>
struct EnumNames<NormalEncoding> {
  static constexpr std::array names{"axis6", "axis26", "oct8", "oct16"};
};
template <>
struct EnumNames<FieldMethod> {
  static constexpr std::array names{"chebyshev", "jfa"};
};
template <>
struct EnumNames<MatrixFormat> {
  static constexpr std::array names{"padded", "csr"};
};
template <>
struct EnumNames<Traversal> {
  static constexpr std::array names{"dda", "sdf"};
};
template <>
struct EnumNames<HitRule> {
  static constexpr std::array names{"thesis", "robust"};
};
template <>
struct EnumNames<SampleFilter> {
  static constexpr std::array names{"nearest", "linear", "blur"};
};
template <>
struct EnumNames<SpecularMode> {
  static constexpr std::array names{"off", "fragment", "compute"};
};
template <>
struct EnumNames<ToneCurve> {
  static constexpr std::array names{"linear", "neutral"};
};
template <>
struct EnumNames<Redo> {
  static constexpr std::array names{"voxels", "field", "matrix", "emission", "gather", "solve", "scatter", "shade", "nothing"};
};
template <>
struct EnumNames<EmitterSampling> {
  static constexpr std::array names{"off", "auto", "on"};
};
template <>
struct EnumNames<EmitterLookup> {
  static constexpr std::array names{"facets", "pixels"};
};
template <>
struct EnumNames<SolverKernel> {
  static constexpr std::array names{"auto", "tree", "subgroup", "row"};
};

template <>
struct EnumNames<EffectMode> {
  static constexpr std::array names{"auto", "on", "off"};
};
template <>
struct EnumNames<Rasterizer> {
  static constexpr std::array names{"auto", "hardware", "kernels"};
};
template <>
struct EnumNames<ViewShape> {
  static constexpr std::array names{"cubes", "slice", "projection", "isosurface", "auto"};
};
template <>
struct EnumNames<Axis> {
  static constexpr std::array names{"x", "y", "z", "auto"};
};
template <>
struct EnumNames<RangeMode> {
  static constexpr std::array names{"standard", "auto", "percentile", "manual"};
};
template <>
struct EnumNames<ColorMap> {
  static constexpr std::array names{"violet-yellow", "heat", "grey"};
};

/// Tag for a uint32_t of an uploaded struct that holds an enumeration's value: visited as that enumeration.
template <class E>
struct EnumRef {
  uint32_t& value;
};
/// The same for a 0/1 word.
struct BoolRef {
  uint32_t& value;
};

/// Calls f(member, Meta) for every setting. `member` is one of: uint32_t&, float&, bool&, enum class&, EnumRef<E>, BoolRef.
template <class F>
void visit(Settings& s, F&& f) {
  using enum Redo;
  f(s.voxel.resolution, Meta{"voxel.resolution", 8, 1022, "voxels", "Voxels along the scene's longest axis (N).", Voxels});
  f(s.voxel.method, Meta{"voxel.method", 0, 0, "", "raster: dominant-axis rasterization (T 5.1.2, leaves pin-holes); conservative: separating-axis test, watertight.", Voxels});
  f(s.voxel.facets, Meta{"voxel.facets", 1, 4, "", "Facets that a voxel may hold; 2 keeps both sides of thin walls, 4 of a sheet before a wall too.", Voxels});
  f(s.voxel.normals, Meta{"voxel.normals", 0, 0, "", "Encoding of facet normals.", Voxels});
  f(s.field.method, Meta{"field.method", 0, 0, "", "Distance field that sdf traversals read.", Field});
  f(s.matrix.format, Meta{"matrix.format", 0, 0, "", "padded: fixed stride, 8 B per hit (T Fig. 7); csr: exact size, 4 B per distinct column.", Matrix});
  f(s.matrix.gpu.rays, Meta{"matrix.rays", 1, 4096, "rays", "Rays per facet (N of METHOD section 5).", Matrix});
  f(EnumRef<HitRule>{s.matrix.gpu.hitRule}, Meta{"matrix.hit_rule", 0, 0, "", "Which faces a ray starts from and stops at.", Voxels});
  f(EnumRef<Traversal>{s.matrix.gpu.traversal}, Meta{"matrix.traversal", 0, 0, "", "dda: cell by cell; sdf: skips the empty space that the field proves.", Matrix});
  f(BoolRef{s.matrix.gpu.jitter}, Meta{"matrix.jitter", 0, 1, "", "Shift the direction set per voxel (Cranley-Patterson).", Matrix});
  f(s.matrix.emitterSampling, Meta{"matrix.emitter_sampling", 0, 0, "", "First gather from emissive facets by samples of them instead of the row's rays; auto: where they are less than a tenth of all and the sum agrees with the rays'.", Emission});
  f(s.matrix.emitterSamples, Meta{"matrix.emitter_samples", 1, 256, "rays", "Rays per facet to the emitters.", Emission});
  f(s.matrix.gpu.seed, Meta{"matrix.seed", 0, 4294967295.0, "", "Seed of the ray directions (--seed).", Matrix});
  f(s.gather.samples, Meta{"gather.samples", 1, 16, "samples", "Shadow lookups per facet and light.", Gather});
  f(s.solver.gpu.lambda, Meta{"solver.lambda", 0, 2, "", "Artistic gain of T 4.3; 1 leaves the physics alone.", Solve});
  f(s.solver.gpu.omega, Meta{"solver.omega", 0.05, 1, "", "Under-relaxation: (1 - omega) B + omega (...); keeps the answer.", Solve});
  f(s.solver.gpu.flush, Meta{"solver.flush", 0, 1e-3, "W/m^2", "Values below become exact zero.", Solve, true});
  f(s.solver.tolerance, Meta{"solver.tolerance", 1e-7, 1, "", "Error bound, as a share of the largest H, at which the solver sleeps.", Solve, true});
  f(s.solver.sweepsPerFrame, Meta{"solver.sweeps_per_frame", 1, 1000, "sweeps", "Jacobi sweeps per frame of the window.", Solve});
  f(s.solver.maxSweeps, Meta{"solver.max_sweeps", 1, 100000, "sweeps", "Sweeps of a headless solve at most.", Solve});
  f(s.solver.kernel, Meta{"solver.kernel", 0, 0, "", "tree: T 5.8's 64-thread shared-memory tree; subgroup: one subgroup per row; row: one invocation per row.", Solve});
  f(s.scatter.edgeRemoval, Meta{"scatter.edge_removal", 0, 1, "", "T 5.9.1: subtract direct light from the sampled volume.", Scatter});
  f(EnumRef<SampleFilter>{s.sample.gpu.filter_}, Meta{"sample.filter", 0, 0, "", "How shading looks up indirect light.", Scatter});
  f(BoolRef{s.sample.gpu.premultiplied}, Meta{"sample.premultiplied", 0, 1, "", "Divide by the presence in alpha (T eq. 24).", Shade});
  f(BoolRef{s.sample.gpu.gated}, Meta{"sample.gated", 0, 1, "", "Take only facets that face the same way, so that walls do not leak.", Scatter});
  f(s.sample.gpu.normalOffset, Meta{"sample.normal_offset", 0, 2, "voxels", "Offset of the lookup along the normal.", Shade});
  f(s.sample.emitters, Meta{"sample.emitters", 0, 0, "", "Light straight from emissive faces: facets: as all of H; pixels: of each pixel from the triangles' true outlines, with shadow rays.", Shade});
  f(s.sample.emitterRays, Meta{"sample.emitter_rays", 1, 256, "rays", "Shadow rays per pixel to emissive triangles.", Shade});
  f(s.specular.mode, Meta{"specular.mode", 0, 0, "", "Where specular rays are traced: in the forward fragment shader (T 5.11) or in compute over the G-buffer.", Shade});
  f(s.specular.gpu.rays, Meta{"specular.rays", 1, 64, "rays", "Specular rays per pixel; a quarter as many more go to emissive faces.", Shade});
  f(EnumRef<Traversal>{s.specular.gpu.traversal}, Meta{"specular.traversal", 0, 0, "", "Traversal of specular rays.", Shade});
  f(s.specular.gpu.maxRoughness, Meta{"specular.max_roughness", 0, 1, "", "Rougher surfaces take the diffuse irradiance instead of rays.", Shade});
  f(s.specular.gpu.fade, Meta{"specular.fade", 0, 1, "", "Width of the blend below max_roughness.", Shade});
  f(s.specular.gpu.threshold, Meta{"specular.threshold", 0, 1, "", "No rays where F0 x H is below this share of the scene's largest H.", Shade, true});
  f(BoolRef{s.specular.gpu.filter_}, Meta{"specular.filter", 0, 1, "", "Edge-aware filter over traced reflections.", Shade});
  f(s.light.shadowResolution, Meta{"light.shadow_resolution", 64, 8192, "texels", "Shadow-map size; point lights use half per cube face.", Gather});
  f(s.camera.exposureEv, Meta{"camera.exposure", -16, 16, "EV", "Exposure of the displayed picture; EXR files stay linear.", Nothing});
  f(EnumRef<ToneCurve>{s.camera.gpu.toneCurve}, Meta{"camera.tone_curve", 0, 0, "", "linear, or Khronos PBR Neutral.", Nothing});
  f(s.camera.gpu.shadowBias, Meta{"camera.shadow_bias", 0, 10, "texels", "Normal offset of shadow lookups.", Gather});
  f(s.camera.gpu.pcf, Meta{"camera.pcf", 1, 5, "taps", "Percentage-closer filter taps per axis.", Gather, false, 2});
  f(BoolRef{s.camera.gpu.specularDirect}, Meta{"camera.specular_direct", 0, 1, "", "Specular lobe of direct lights.", Shade});
  f(s.view.shape, Meta{"view.shape", 0, 0, "", "How a volume is shown: cubes where it is solid, a slice, a projection along the line of sight (distances: the sum of their inverses, T Fig. 5c; errors: the largest; else the mean), the surface at a distance; auto: as suits the view.", Nothing});
  f(s.view.axis, Meta{"view.axis", 0, 0, "", "Axis across the slice; auto: the one that the camera looks along most.", Nothing});
  f(s.view.slice, Meta{"view.slice", 0, 1, "", "Place of the slice along its axis, as a share of the grid.", Nothing});
  f(s.view.isovalue, Meta{"view.isovalue", 0, 64, "voxels", "Distance at which fields are shown as cubes or isosurface.", Nothing});
  f(s.view.jfaPass, Meta{"view.jfa_pass", 0, 11, "", "Jump-flood pass after which its seeds are shown; 0: before the first, more than there are: the last.", Nothing});
  f(s.view.light, Meta{"view.light", 0, 4096, "", "Light of the shadow views, by index.", Nothing});
  f(s.view.facet, Meta{"view.facet", 0, 2147483647, "", "Facet whose row the view matrix-row shows, by index; in the window the one that the inspector has.", Nothing});
  f(s.view.range, Meta{"view.range", 0, 0, "", "Values that the colour map's ends stand for. standard: the view's own, auto where it has none; auto: the picture's smallest and largest.", Nothing});
  f(s.view.low, Meta{"view.low", -1e6, 1e6, "", "Lower end of the manual range.", Nothing});
  f(s.view.high, Meta{"view.high", -1e6, 1e6, "", "Upper end of the manual range; signed views take the larger magnitude to both sides.", Nothing});
  f(s.view.percentile, Meta{"view.percentile", 50, 100, "%", "Upper end of the percentile range; the lower is 100 less this.", Nothing});
  f(s.view.colorMap, Meta{"view.color_map", 0, 0, "", "Colours of scalar views, even in lightness; signed views are always blue-red.", Nothing});
  f(s.thesis.literal, Meta{"thesis.literal", 0, 1, "", "Bring back the thesis's plain slips, to show what they cost.", Voxels});
  f(s.effects.emission, Meta{"effects.emission", 0, 0, "", "Light of emissive surfaces, and themselves in the picture; auto: where a material emits.", Voxels});
  f(s.effects.sun, Meta{"effects.sun", 0, 0, "", "Suns with their shadow maps; auto: those with an intensity.", Gather});
  f(s.effects.point, Meta{"effects.point", 0, 0, "", "Point lights with their shadow maps; auto: those with an intensity whose range reaches the scene.", Gather});
  f(s.effects.spot, Meta{"effects.spot", 0, 0, "", "Spot lights with their shadow maps; auto: those with an intensity whose range and cone reach the scene.", Gather});
  f(s.effects.matrix, Meta{"effects.matrix", 0, 0, "", "Indirect light: matrix and solver; auto: where there is light, and something that reflects it.", Matrix});
  f(s.effects.specular, Meta{"effects.specular", 0, 0, "", "Reflections; auto: where there is light, and a material that is not Lambertian.", Shade});
  f(s.effects.secondFacet, Meta{"effects.second_facet", 0, 0, "", "Search for second facets of voxels; auto: unless it is known to find none. off: as voxel.facets=1.", Nothing});
  f(s.effects.field, Meta{"effects.field", 0, 0, "", "Distance field kept beside the voxels; auto: where rays read it.", Shade});
  f(s.effects.relight, Meta{"effects.relight", 0, 0, "", "Gather, solve and scatter; auto: until the error bound is below solver.tolerance; on: in every frame of the window; off: the light stays as it is.", Nothing});
  f(s.effects.alphaTest, Meta{"effects.alpha_test", 0, 0, "", "Cut-outs by alpha; auto: where a material has one.", Voxels});
  f(s.effects.normalMap, Meta{"effects.normal_map", 0, 0, "", "Normal maps; auto: where a material has one.", Shade});
  f(s.effects.blur, Meta{"effects.blur", 0, 0, "", "Blur of sample.filter=blur; off: as sample.filter=linear; auto: where it changes H by more than effects.blur_noise.", Scatter});
  f(s.effects.blurNoise, Meta{"effects.blur_noise", 0, 1, "", "Largest change of H, as a share of the largest, that is left to noise: below, there is no blur.", Scatter});
  f(s.rasterizer, Meta{"device.rasterizer", 0, 0, "", "Who rasterizes voxels (voxel.method=raster), shadow maps and pictures: the graphics pipeline or compute kernels; auto: kernels where few of the GPU's processors serve the graphics pipeline.", Voxels});
  f(s.scene.lambertian, Meta{"scene.lambertian", 0, 1, "", "Every material Lambertian with its base colour (read at load).", Voxels});
  f(s.scene.doubleSided, Meta{"scene.double_sided", 0, 1, "", "Every material double-sided, as path tracers without culling have them (read at load).", Voxels});
}

/// "thesis", "fast", "balanced", "reference": every setting but the seed, the exposure, the tone curve, the view,
/// device.rasterizer and scene.*, which are the user's own; UsageError lists the names. `cpuDevice` picks the sizes by device class (METHOD: CPU
/// rasterizer N = 64, 128 rays; GPU N = 256, 384 rays); thesis is the same everywhere.
void applyPreset(Settings& settings, std::string_view name, bool cpuDevice = false);
Settings defaultSettings(bool cpuDevice);
std::vector<std::string> presetNames();

/// One "name=value"; UsageError names the near matches of an unknown name, or the range of a bad value.
void applySetting(Settings& settings, std::string_view assignment);
/// Value as --set would take it.
std::string settingValue(const Settings& settings, std::string_view name);
/// First stage that must run again to go from `a` to `b`.
Redo difference(const Settings& a, const Settings& b);

/// One setting as tables show it.
struct SettingInfo {
  Meta meta;
  std::string kind;  ///< "integer", "number", "switch" or "choice"
  std::vector<std::string> choices;  ///< of a choice, in order
  std::string value;
  std::string range() const;  ///< "1 to 4096 rays", "padded | csr", "true | false"
};
std::vector<SettingInfo> settingInfos(const Settings& settings);

std::string settingsToJson(const Settings& settings, int indent = 2);  ///< {"voxel.resolution": 64, ...}
void settingsFromJson(Settings& settings, std::string_view json);     ///< UsageError on unknown names or bad values

}  // namespace irad
