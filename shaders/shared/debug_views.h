// The list of views: combo box, --view, exports and legends come from it. GLSL takes the constants, C++ the table.
//   X(CONSTANT, number, name, label, unit, kind, range low, range high)
// A new view is one row here and one case in shaders/view/debug_view.comp or voxel_view.comp.
#ifndef IRAD_SHARED_DEBUG_VIEWS_H
#define IRAD_SHARED_DEBUG_VIEWS_H
#include "shared/types.h"
IRAD_BEGIN

// Kinds: how `linear` becomes `display`.
IRAD_CONST uint VIEW_KIND_LIGHT = 0u;       ///< radiance: exposure, tone curve
IRAD_CONST uint VIEW_KIND_IRRADIANCE = 1u;  ///< W/m^2: shown as the radiance of a white surface, / pi, then as light
IRAD_CONST uint VIEW_KIND_COLOR = 2u;       ///< 0..1, encoded as it is
IRAD_CONST uint VIEW_KIND_NORMAL = 3u;      ///< -1..1 to 0..1, no transfer function
IRAD_CONST uint VIEW_KIND_SCALAR = 4u;      ///< colour map over the range (high <= low: up to the far plane)

// clang-format off
#define IRAD_VIEWS(X) \
  X(LIT,                 0, "lit",                 "Lit",                         "W/(m^2 sr)", LIGHT,      0.0f, 1.0f) \
  X(NO_GI,               1, "no-gi",               "No GI",                       "W/(m^2 sr)", LIGHT,      0.0f, 1.0f) \
  X(DIRECT,              2, "direct",              "Direct light",                "W/(m^2 sr)", LIGHT,      0.0f, 1.0f) \
  X(INDIRECT,            3, "indirect",            "Indirect diffuse light",      "W/(m^2 sr)", LIGHT,      0.0f, 1.0f) \
  X(SPECULAR,            4, "specular",            "Indirect specular light",     "W/(m^2 sr)", LIGHT,      0.0f, 1.0f) \
  X(ALBEDO,              5, "albedo",              "Albedo",                      "",           COLOR,      0.0f, 1.0f) \
  X(NORMAL,              6, "normal",              "Shading normal",              "",           NORMAL,    -1.0f, 1.0f) \
  X(ROUGHNESS_METALLIC,  7, "roughness-metallic",  "Roughness, metallic",         "",           COLOR,      0.0f, 1.0f) \
  X(DEPTH,               8, "depth",               "Depth",                       "m",          SCALAR,     0.0f, 0.0f) \
  X(DIRECT_IRRADIANCE,   9, "direct-irradiance",   "Direct irradiance (D + F M)", "W/m^2",      IRRADIANCE, 0.0f, 1.0f) \
  X(IRRADIANCE,         10, "irradiance",          "Indirect irradiance H",       "W/m^2",      IRRADIANCE, 0.0f, 1.0f) \
  X(VOXEL_ALBEDO,       11, "voxel-albedo",        "Voxels: albedo",              "",           COLOR,      0.0f, 1.0f) \
  X(VOXEL_NORMAL,       12, "voxel-normal",        "Voxels: normal",              "",           NORMAL,    -1.0f, 1.0f) \
  X(VOXEL_EMISSION,     13, "voxel-emission",      "Voxels: emission M",          "W/m^2",      IRRADIANCE, 0.0f, 1.0f) \
  X(VOXEL_IRRADIANCE,   14, "voxel-irradiance",    "Voxels: irradiance H",        "W/m^2",      IRRADIANCE, 0.0f, 1.0f) \
  X(FACET_COUNT,        15, "facet-count",         "Voxels: facets",              "facets",     SCALAR,     0.0f, 2.0f) \
  X(DISTANCE,           16, "distance",            "Distance field (inverse, summed)", "",      SCALAR,     0.0f, 32.0f) \
  X(RADIOSITY,          17, "radiosity",           "Voxels: radiosity B",         "W/m^2",      IRRADIANCE, 0.0f, 1.0f) \
  X(ROW_OCCUPANCY,      18, "row-occupancy",       "Voxels: row entries / rays",  "",           SCALAR,     0.0f, 1.0f) \
  X(ROW_SUM,            19, "row-sum",             "Voxels: row sum of F",        "",           SCALAR,     0.0f, 1.0f) \
  X(INVALID_RAYS,       20, "invalid-rays",        "Voxels: invalid rays / rays", "",           SCALAR,     0.0f, 0.25f) \
  X(EMITTER_IRRADIANCE, 21, "emitter-irradiance",  "Irradiance from emitters F M", "W/m^2",     IRRADIANCE, 0.0f, 1.0f) \
  X(REFERENCE,          22, "reference",           "Voxels: irradiance H by the oracle", "W/m^2", IRRADIANCE, 0.0f, 1.0f)
// clang-format on

#define IRAD_VIEW_CONSTANT(constant, number, name, label, unit, kind, low, high) \
  IRAD_CONST uint VIEW_##constant = uint(number);
IRAD_VIEWS(IRAD_VIEW_CONSTANT)
#undef IRAD_VIEW_CONSTANT

IRAD_END
#endif
