// Every setting once: a plain struct of members, and a table with a row for each (gi/settings_table.cpp) that gives
// name, range, unit, help, and what must be redone when it changes. Widgets, --set, JSON, presets, `irad settings`,
// reset buttons, the stages' keys and the round-trip test all come from the table: a new setting is one more member and
// one more row.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shaders/shared/color_map.h"
#include "shaders/shared/enumeration.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/light_kinds.h"
#include "shaders/shared/matrix.h"
#include "shaders/shared/normals.h"
#include "shaders/shared/scene_gpu.h"
#include "shaders/shared/view.h"

namespace irad {

// clang-format off
#define IRAD_VOXEL_METHODS(X) X(raster, "raster") X(conservative, "conservative")
#define IRAD_FIELD_METHODS(X) X(chebyshev, "chebyshev") X(jfa, "jfa")
#define IRAD_SPECULAR_MODES(X) X(off, "off") X(fragment, "fragment") X(compute, "compute")
#define IRAD_WRITEBACK_MODES(X) X(off, "off") X(mask, "mask") X(compute, "compute")
#define IRAD_EMITTER_LOOKUPS(X) X(automatic, "auto") X(facets, "facets") X(pixels, "pixels")
#define IRAD_SOLVER_METHODS(X) X(matrix, "matrix") X(bruteForce, "brute_force")
#define IRAD_SOLVER_KERNELS(X) X(automatic, "auto") X(tree, "tree") X(subgroup, "subgroup") X(row, "row")
#define IRAD_SOLVER_ACCELERATIONS(X) X(off, "off") X(anderson, "anderson")
#define IRAD_RASTERIZERS(X) X(automatic, "auto") X(hardware, "hardware") X(kernels, "kernels")
#define IRAD_EFFECT_MODES(X) X(automatic, "auto") X(on, "on") X(off, "off")
#define IRAD_SKY_SOURCES(X) X(none, "none") X(constant, "constant") X(image, "image") X(preetham, "preetham")
#define IRAD_REGION_MODES(X) X(automatic, "auto") X(whole, "whole") X(box, "box")
#define IRAD_REDOS(X) \
  X(Voxels, "voxels") X(Field, "field") X(Matrix, "matrix") X(Materials, "materials") X(Emission, "emission") \
  X(Gather, "gather") X(Solve, "solve") X(Scatter, "scatter") X(Shade, "shade") X(Nothing, "nothing")
// clang-format on

IRAD_ENUM(VoxelMethod, IRAD_VOXEL_METHODS)
IRAD_ENUM(FieldMethod, IRAD_FIELD_METHODS)
IRAD_ENUM(SpecularMode, IRAD_SPECULAR_MODES)
/// How reflections become a source of the facets that show them (docs/method.md 8).
IRAD_ENUM(WritebackMode, IRAD_WRITEBACK_MODES)
/// Who gives a pixel the light that comes straight from emissive faces: the facets around it, or their triangles.
IRAD_ENUM(EmitterLookup, IRAD_EMITTER_LOOKUPS)
/// Where F in H = F B comes from: a matrix that is built once, or rays that are traced anew in every frame.
IRAD_ENUM(SolverMethod, IRAD_SOLVER_METHODS)
IRAD_ENUM(SolverKernel, IRAD_SOLVER_KERNELS)
/// What becomes of the sweeps' results (docs/method.md 1): the next sweep's input, or a mix of them.
IRAD_ENUM(SolverAcceleration, IRAD_SOLVER_ACCELERATIONS)
/// Who turns triangles into pixels: the graphics pipeline, or compute kernels (shaders/raster).
IRAD_ENUM(Rasterizer, IRAD_RASTERIZERS)
IRAD_ENUM(SkySource, IRAD_SKY_SOURCES)
/// Which part of the scene has voxels (gi/region.h).
IRAD_ENUM(RegionMode, IRAD_REGION_MODES)
/// Whether an effect (gi/plan.h) runs. automatic: where the scene calls for it; on: always; off: never.
IRAD_ENUM(EffectMode, IRAD_EFFECT_MODES)
/// The first stage that has to run again when a setting changes; later ones follow. Ordered. (Materials: rho and M of
/// the facets. Emission: the first gather from emissive facets, F M of docs/method.md 6.)
IRAD_ENUM(Redo, IRAD_REDOS)

struct VoxelSettings {
  uint32_t resolution = 64;  ///< N: voxels along the longest axis
  VoxelMethod method = VoxelMethod::conservative;
  NormalEncoding normals = NormalEncoding::oct16;
  bool operator==(const VoxelSettings&) const = default;
};
struct FieldSettings {
  FieldMethod method = FieldMethod::chebyshev;
  bool operator==(const FieldSettings&) const = default;
};
struct MatrixSettings {
  MatrixFormat format = MatrixFormat::csr;
  MatrixParams gpu{128, HitRule::triangles, Traversal::sdf, true, 0};
  EffectMode emitterSampling = EffectMode::automatic;
  uint32_t emitterSamples = 32;  ///< per facet
  bool operator==(const MatrixSettings&) const = default;
};
struct SolverSettings {
  SolverMethod method = SolverMethod::matrix;
  SolverParams gpu{1.0f, 1.0f, 1e-12f};
  float tolerance = 2e-3f;      ///< stop when the error bound is below this share of the mean H
  uint32_t sweepsPerFrame = 4;  ///< interactive; headless runs until the tolerance or maxSweeps
  uint32_t maxSweeps = 1000;
  uint32_t frames = 256;  ///< of brute force, at most
  SolverKernel kernel = SolverKernel::automatic;
  SolverAcceleration acceleration = SolverAcceleration::anderson;
  bool operator==(const SolverSettings&) const = default;
};
struct ScatterSettings {
  bool edgeRemoval = false;  ///< T 5.9.1: the volume holds B - lambda E instead of H
  bool operator==(const ScatterSettings&) const = default;
};
struct SampleSettings {
  SampleParams gpu{SampleFilter::blur, true, 0.5f};
  EmitterLookup emitters = EmitterLookup::automatic;
  uint32_t emitterRays = 8;  ///< per pixel
  bool operator==(const SampleSettings&) const = default;
};
struct SpecularSettings {
  SpecularMode mode = SpecularMode::compute;
  SpecularParams gpu{4, Traversal::sdf, 0.6f, 1.0f, 0.15f, 1e-4f, true};
  bool operator==(const SpecularSettings&) const = default;
};
struct WritebackSettings {
  WritebackMode mode = WritebackMode::off;
  WritebackParams gpu{0.5f, 1.0f, 0.9f};
  bool operator==(const WritebackSettings&) const = default;
};
struct LightSettings {
  uint32_t shadowResolution = 2048;  ///< texels per side; point lights use half per cube face
  ShadowFilter shadowFilter = ShadowFilter::pcf;
  float bleedReduction = 0.3f;  ///< of ShadowFilter::vsm
  uint32_t points = 16;         ///< of a light with a size, that are looked at from a pixel or a facet
  bool operator==(const LightSettings&) const = default;
};
/// Light from where no surface is (gi/sky.h).
struct SkySettings {
  SkySource source = SkySource::none;
  float intensity = 1;                 ///< factor; of a constant sky its radiance, W/(m^2 sr)
  float rotation = 0;                  ///< about +Y, degrees
  float red = 1, green = 1, blue = 1;  ///< of a constant sky, linear
  // Of Preetham's: haze, and where the sun is if it is not the scene's first; degrees, the azimuth from -Z towards +X.
  float turbidity = 3, elevation = 45, azimuth = 0;
  bool coupled = true;
  float ground = 0.2f;  ///< albedo of what is below its horizon
  bool operator==(const SkySettings&) const = default;
};
struct CameraSettings {
  float exposureEv = 0.0f;
  bool autoExposure = false;
  uint32_t glassLayers = 4;  ///< blended surfaces behind each other that a picture shows
  ShadeParams gpu{1.0f, ToneCurve::neutral, 1.5f, 3, true};
  bool operator==(const CameraSettings&) const = default;
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
  bool operator==(const ViewSettings&) const = default;
};
struct ThesisSettings {
  bool literal = false;  ///< bring back the thesis's slips (docs/method.md)
  bool operator==(const ThesisSettings&) const = default;
};

/// Overrides of the effect plan.
struct EffectSettings {
  EffectMode emission{}, sky{}, matrix{}, specular{}, writeback{}, field{}, relight{}, alphaTest{}, glass{},
      normalMap{}, blur{};
  // One for each kind of light: sun, point, spot.
#define IRAD_LIGHT_MODE(constant, number, id, effect, gltf, name, one, many, map, traits) EffectMode effect{};
  IRAD_LIGHT_KINDS(IRAD_LIGHT_MODE)
#undef IRAD_LIGHT_MODE
  float blurNoise = 2e-3f;  ///< the blur is left out where it changes H by less than this share of the largest
  bool operator==(const EffectSettings&) const = default;
};

struct RegionSettings {
  RegionMode mode = RegionMode::automatic;
  float x0 = -1, y0 = -1, z0 = -1, x1 = 1, y1 = 1, z1 = 1;  ///< of RegionMode::box: two of its corners, world
  bool operator==(const RegionSettings&) const = default;
};
/// How the scene's file is read (LoadOptions), and which part of it has voxels.
struct SceneSettings {
  bool lambertian = false, doubleSided = false;
  RegionSettings region;
  bool operator==(const SceneSettings&) const = default;
};

struct Settings {
  VoxelSettings voxel;
  FieldSettings field;
  MatrixSettings matrix;
  SolverSettings solver;
  ScatterSettings scatter;
  SampleSettings sample;
  SpecularSettings specular;
  WritebackSettings writeback;
  LightSettings light;
  SkySettings sky;
  CameraSettings camera;
  ViewSettings view;
  ThesisSettings thesis;
  EffectSettings effects;
  Rasterizer rasterizer = Rasterizer::automatic;  ///< device.rasterizer
  SceneSettings scene;
  bool operator==(const Settings&) const = default;
};

#define IRAD_SETTING_KINDS(X) X(integer, "integer") X(number, "number") X(toggle, "switch") X(choice, "choice")
IRAD_ENUM(SettingKind, IRAD_SETTING_KINDS)

/// What a number may be.
struct SettingRange {
  double min = 0, max = 0;
  const char* unit = "";
  bool logarithmic = false;
  double step = 0;  ///< > 0: only min + k step is allowed
};

/// A row of the table: what there is to know of a setting, and its value in any Settings.
struct Setting {
  const char* name;  ///< "group.member", as --set takes it
  SettingKind kind;
  SettingRange range;  ///< of integers and numbers
  const char* help;    ///< one sentence
  Redo redo;
  std::span<const char* const> choices;  ///< of a choice, in order
  /// The value as a number: 1 and 0 of a switch, the index of a choice. A double holds each of them exactly.
  double (*get)(const Settings&);
  void (*set)(Settings&, double);

  std::string_view group() const;           ///< "voxel"
  std::string allowed() const;              ///< "1 to 4096 rays", "padded | csr", "true | false"
  std::string text(const Settings&) const;  ///< the value, as --set takes it
  /// The value from such text; UsageError says what is allowed.
  void assign(Settings&, std::string_view text) const;
};
/// Every setting, group after group.
std::span<const Setting> settingTable();
/// UsageError names the near matches.
const Setting& findSetting(std::string_view name);

/// "thesis", "fast", "balanced", "reference": every setting but the seed, the exposures, the tone curve, the view, the
/// sky, device.rasterizer and scene.*, which are the user's own; UsageError lists the names. `cpuDevice` picks the
/// sizes by device class (CPU rasterizer N = 64, 128 rays; GPU N = 256, 384 rays); thesis is the same everywhere.
void applyPreset(Settings& settings, std::string_view name, bool cpuDevice = false);
Settings defaultSettings(bool cpuDevice);
std::vector<std::string> presetNames();

/// UsageError where values do not go together: what is the thesis's alone, and its hit rule; a box and its corners.
void requireMatching(const Settings& settings);

/// One "name=value" (or camera.exposure=auto, scene.region=x0,y0,z0,x1,y1,z1); UsageError names the near matches of an
/// unknown name, or the range of a bad value.
void applySetting(Settings& settings, std::string_view assignment);

std::string settingsToJson(const Settings& settings, int indent = 2);  ///< {"voxel.resolution": 64, ...}
void settingsFromJson(Settings& settings, std::string_view json);      ///< UsageError on unknown names or bad values

}  // namespace irad
