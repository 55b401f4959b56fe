// The list of views: combo box, --view, exports and legends come from it. GLSL takes the constants, C++ the table.
//   X(CONSTANT, number, name, label, unit, group, kind, range low, range high)
// A new view is one row here and one case in the shader that draws its group: shaders/view/debug_view.comp (over the
// targets of the forward pass) or voxel_values.glsl (over the voxels). The groups are headings of the combo box; the
// range is the view's standard one (low == high: it has none, and takes the picture's).
#ifndef IRAD_SHARED_DEBUG_VIEWS_H
#define IRAD_SHARED_DEBUG_VIEWS_H
#include "shared/types.h"
IRAD_BEGIN

// Kinds: how `linear` becomes `display`.
IRAD_CONST uint VIEW_KIND_LIGHT = 0u;       ///< radiance: exposure, tone curve
IRAD_CONST uint VIEW_KIND_IRRADIANCE = 1u;  ///< W/m^2: shown as the radiance of a white surface, / pi, then as light
IRAD_CONST uint VIEW_KIND_COLOR = 2u;       ///< 0..1, encoded as it is
IRAD_CONST uint VIEW_KIND_NORMAL = 3u;      ///< -1..1 to 0..1, no transfer function
IRAD_CONST uint VIEW_KIND_SCALAR = 4u;      ///< >= 0: view.color_map over the range
IRAD_CONST uint VIEW_KIND_SIGNED = 5u;      ///< the diverging map over a range that is even about 0
IRAD_CONST uint VIEW_KIND_SITE = 6u;        ///< a voxel's coordinates: its place as colour

/// Kinds whose colours depend on a range.
IRAD_FN bool viewHasRange(uint kind) { return kind == VIEW_KIND_SCALAR || kind == VIEW_KIND_SIGNED; }
/// Kinds of which a value below zero is no mistake.
IRAD_FN bool viewHasSign(uint kind) {
  return kind == VIEW_KIND_NORMAL || kind == VIEW_KIND_SIGNED || kind == VIEW_KIND_SITE;
}

// clang-format off
#define IRAD_VIEWS(X) \
  X(LIT,                  0, "lit",                 "Lit",                                 "W/(m^2 sr)",  "Picture",   LIGHT,         0.0f,   1.0f) \
  X(NO_GI,                1, "no-gi",               "No GI",                               "W/(m^2 sr)",  "Picture",   LIGHT,         0.0f,   1.0f) \
  X(DIRECT,               2, "direct",              "Direct light",                        "W/(m^2 sr)",  "Picture",   LIGHT,         0.0f,   1.0f) \
  X(INDIRECT,             3, "indirect",            "Indirect diffuse light",              "W/(m^2 sr)",  "Picture",   LIGHT,         0.0f,   1.0f) \
  X(SPECULAR,             4, "specular",            "Indirect specular light",             "W/(m^2 sr)",  "Picture",   LIGHT,         0.0f,   1.0f) \
  X(ALBEDO,               5, "albedo",              "Albedo",                              "",            "Surface",   COLOR,         0.0f,   1.0f) \
  X(NORMAL,               6, "normal",              "Shading normal",                      "",            "Surface",   NORMAL,       -1.0f,   1.0f) \
  X(ROUGHNESS_METALLIC,   7, "roughness-metallic",  "Roughness, metallic",                 "",            "Surface",   COLOR,         0.0f,   1.0f) \
  X(DEPTH,                8, "depth",               "Depth",                               "m",           "Surface",   SCALAR,        0.0f,   0.0f) \
  X(DIRECT_IRRADIANCE,    9, "direct-irradiance",   "Direct irradiance (D + F M)",         "W/m^2",       "Surface",   IRRADIANCE,    0.0f,   1.0f) \
  X(IRRADIANCE,          10, "irradiance",          "Indirect irradiance H",               "W/m^2",       "Surface",   IRRADIANCE,    0.0f,   1.0f) \
  X(VOXEL_ALBEDO,        11, "voxel-albedo",        "Voxels: albedo",                      "",            "Voxels",    COLOR,         0.0f,   1.0f) \
  X(VOXEL_NORMAL,        12, "voxel-normal",        "Voxels: normal",                      "",            "Voxels",    NORMAL,       -1.0f,   1.0f) \
  X(VOXEL_EMISSION,      13, "voxel-emission",      "Voxels: emission M",                  "W/m^2",       "Voxels",    IRRADIANCE,    0.0f,   1.0f) \
  X(VOXEL_IRRADIANCE,    14, "voxel-irradiance",    "Voxels: irradiance H",                "W/m^2",       "Voxels",    IRRADIANCE,    0.0f,   1.0f) \
  X(FACET_COUNT,         15, "facet-count",         "Voxels: facets",                      "facets",      "Voxels",    SCALAR,        0.0f,   2.0f) \
  X(DISTANCE,            16, "distance",            "Distance field in use",               "voxels",      "Distance",  SCALAR,        0.0f,   0.0f) \
  X(RADIOSITY,           17, "radiosity",           "Voxels: radiosity B",                 "W/m^2",       "Voxels",    IRRADIANCE,    0.0f,   1.0f) \
  X(ROW_OCCUPANCY,       18, "row-occupancy",       "Row entries / rays",                  "",            "Matrix",    SCALAR,        0.0f,   1.0f) \
  X(ROW_SUM,             19, "row-sum",             "Row sum of F",                        "",            "Matrix",    SCALAR,        0.0f,   1.0f) \
  X(INVALID_RAYS,        20, "invalid-rays",        "Invalid rays / rays",                 "",            "Matrix",    SCALAR,        0.0f,  0.25f) \
  X(EMITTER_IRRADIANCE,  21, "emitter-irradiance",  "Irradiance from emitters F M",        "W/m^2",       "Surface",   IRRADIANCE,    0.0f,   1.0f) \
  X(REFERENCE,           22, "reference",           "Voxels: irradiance H by the oracle",  "W/m^2",       "Voxels",    IRRADIANCE,    0.0f,   1.0f) \
  X(DISTANCE_CHEBYSHEV,  23, "distance-chebyshev",  "Chebyshev field",                     "voxels",      "Distance",  SCALAR,        0.0f,   0.0f) \
  X(DISTANCE_JFA,        24, "distance-jfa",        "Jump-flood field (8 bits)",           "voxels",      "Distance",  SCALAR,        0.0f,   0.0f) \
  X(JFA_SEEDS,           25, "jfa-seeds",           "Jump-flood seeds after a pass",       "",            "Distance",  SITE,          0.0f,   0.0f) \
  X(JFA_ERROR,           26, "jfa-error",           "Jump flood after a pass, less exact", "voxels",      "Distance",  SCALAR,        0.0f,   0.0f) \
  X(JFA_FIELD_ERROR,     27, "jfa-field-error",     "Jump-flood field, less exact",        "voxels",      "Distance",  SIGNED,        0.0f,   0.0f) \
  X(CHEBYSHEV_ERROR,     28, "chebyshev-error",     "Chebyshev field, less exact",         "voxels",      "Distance",  SIGNED,        0.0f,   0.0f) \
  X(VOXEL_DIRECT,        29, "voxel-direct",        "Voxels: direct irradiance D",         "W/m^2",       "Voxels",    IRRADIANCE,    0.0f,   1.0f) \
  X(PIN_HOLES,           30, "pin-holes",           "Surface to the nearest solid voxel",        "voxels",      "Voxels",    SCALAR,        0.0f,   1.0f) \
  X(SHADOW_MAP,          31, "shadow-map",          "Shadow map of a light",               "m",           "Lights",    SCALAR,        0.0f,   0.0f) \
  X(SHADOW,              32, "shadow",              "Share of a light that arrives",       "",            "Lights",    SCALAR,        0.0f,   1.0f) \
  X(REFERENCE_PICTURE,   33, "reference-picture",   "Reference picture",                   "W/(m^2 sr)",  "Reference", LIGHT,         0.0f,   1.0f) \
  X(ERROR,               34, "error",               "Relative error of lit, signed",       "",            "Reference", SIGNED,       -0.5f,   0.5f) \
  X(MATRIX_ROW,          35, "matrix-row",          "Matrix row: F to each facet",         "",            "Matrix",    SCALAR,        0.0f,   0.0f)
// clang-format on

#define IRAD_VIEW_CONSTANT(constant, number, name, label, unit, group, kind, low, high) \
  IRAD_CONST uint VIEW_##constant = uint(number);
IRAD_VIEWS(IRAD_VIEW_CONSTANT)
#undef IRAD_VIEW_CONSTANT

IRAD_END
#endif
