// The list of views: combo box, --view, exports and legends come from it. GLSL takes the constants, C++ the table.
//   X(CONSTANT, number, name, label, unit, group, kind, range low, range high, shape, what it is drawn from)
// A new view is one row here and one case in the shader that draws what it is drawn from: shaders/view/debug_view.comp
// (the targets of the forward pass) or voxel_values.glsl (voxels and what lies in them). The groups are headings of the
// combo box; the range is the view's standard one (low == high: it has none, and takes the picture's); the shape is that
// which view.shape = auto stands for, of views of volumes.
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

// What a view is drawn from: a sum of these. Those that do not exist draw as empty. Of a picture's stages those run that
// the sum names (sourcesOf() of gi/views/views.h).
IRAD_CONST uint FROM_TARGETS = 1u;         ///< the targets of the forward pass: depth, normals, albedo; beside them
IRAD_CONST uint FROM_EMITTED = 2u;         ///< light that comes straight from emitters
IRAD_CONST uint FROM_FACETS = 4u;          ///< the facet list itself
IRAD_CONST uint FROM_D = 8u;               ///< a value per facet: light that arrives from the analytic lights,
IRAD_CONST uint FROM_H = 16u;              ///< from other facets,
IRAD_CONST uint FROM_B = 32u;              ///< light that leaves,
IRAD_CONST uint FROM_ORACLE = 64u;         ///< H by the oracle,
IRAD_CONST uint FROM_MATRIX_ROW = 128u;    ///< F to it from one facet
IRAD_CONST uint FROM_MATRIX = 256u;        ///< a facet's row
IRAD_CONST uint FROM_FIELD = 512u;         ///< a value per voxel, solid or not: the distance field in use,
IRAD_CONST uint FROM_CHEBYSHEV = 1024u;    ///< the one of either method,
IRAD_CONST uint FROM_JFA = 2048u;
IRAD_CONST uint FROM_JUMP_FLOOD = 4096u;   ///< the seeds after a pass of jump flooding
IRAD_CONST uint FROM_EXACT = 8192u;        ///< less the exact distance
IRAD_CONST uint FROM_SHADOW_MAPS = 16384u; ///< one light's
IRAD_CONST uint FROM_PICTURE = 32768u;     ///< the reference picture
IRAD_CONST uint FROM_STANDARD_ERROR = 65536u; ///< a value per facet: of H by brute force
IRAD_CONST uint FROM_WRITTEN = 131072u;    ///< a value per facet: what the picture writes back to it
IRAD_CONST uint FROM_SKY = 262144u;        ///< a value per facet: of H what comes straight from the sky
IRAD_CONST uint FROM_DEPTH = 524288u;      ///< of the targets the depth alone
IRAD_CONST uint FROM_DIRECT_LIGHT = 1048576u;   ///< with the targets: light that comes straight from lights,
IRAD_CONST uint FROM_INDIRECT_LIGHT = 2097152u; ///< by way of other surfaces,
IRAD_CONST uint FROM_REFLECTIONS = 4194304u;    ///< by way of the surface as a mirror
// What several of them have in common.
IRAD_CONST uint FROM_FACET_VALUES =
    FROM_D | FROM_H | FROM_B | FROM_ORACLE | FROM_MATRIX_ROW | FROM_STANDARD_ERROR | FROM_WRITTEN | FROM_SKY;
IRAD_CONST uint FROM_LIT = FROM_TARGETS | FROM_DIRECT_LIGHT | FROM_INDIRECT_LIGHT | FROM_REFLECTIONS;
IRAD_CONST uint FROM_STORED_FIELD = FROM_FIELD | FROM_CHEBYSHEV | FROM_JFA;
IRAD_CONST uint FROM_ANY_FIELD = FROM_STORED_FIELD | FROM_JUMP_FLOOD;

/// A distance, rather than seeds or errors.
IRAD_FN bool viewIsDistance(uint from) { return (from & FROM_STORED_FIELD) != 0u && (from & FROM_EXACT) == 0u; }

/// Kinds whose colours depend on a range.
IRAD_FN bool viewHasRange(uint kind) { return kind == VIEW_KIND_SCALAR || kind == VIEW_KIND_SIGNED; }
/// Kinds whose values may be below zero.
IRAD_FN bool viewHasSign(uint kind) {
  return kind == VIEW_KIND_NORMAL || kind == VIEW_KIND_SIGNED || kind == VIEW_KIND_SITE;
}

// clang-format off
#define IRAD_VIEWS(X) \
  X(LIT,                 0, "lit",                 "Lit",                                  "W/(m^2 sr)",  "Picture",   LIGHT,        0.0f,   1.0f, NONE,       FROM_LIT) \
  X(NO_GI,               1, "no-gi",               "No GI",                                "W/(m^2 sr)",  "Picture",   LIGHT,        0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_DIRECT_LIGHT) \
  X(DIRECT,              2, "direct",              "Direct light",                         "W/(m^2 sr)",  "Picture",   LIGHT,        0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_DIRECT_LIGHT) \
  X(INDIRECT,            3, "indirect",            "Indirect diffuse light",               "W/(m^2 sr)",  "Picture",   LIGHT,        0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_INDIRECT_LIGHT) \
  X(SPECULAR,            4, "specular",            "Indirect specular light",              "W/(m^2 sr)",  "Picture",   LIGHT,        0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_REFLECTIONS) \
  X(ALBEDO,              5, "albedo",              "Albedo",                               "",            "Surface",   COLOR,        0.0f,   1.0f, NONE,       FROM_TARGETS) \
  X(NORMAL,              6, "normal",              "Shading normal",                       "",            "Surface",   NORMAL,      -1.0f,   1.0f, NONE,       FROM_TARGETS) \
  X(ROUGHNESS_METALLIC,  7, "roughness-metallic",  "Roughness, metallic",                  "",            "Surface",   COLOR,        0.0f,   1.0f, NONE,       FROM_TARGETS) \
  X(DEPTH,               8, "depth",               "Depth",                                "m",           "Surface",   SCALAR,       0.0f,   0.0f, NONE,       FROM_DEPTH) \
  X(DIRECT_IRRADIANCE,   9, "direct-irradiance",   "Direct irradiance (D + F M)",          "W/m^2",       "Surface",   IRRADIANCE,   0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_DIRECT_LIGHT | FROM_EMITTED) \
  X(IRRADIANCE,         10, "irradiance",          "Indirect irradiance H",                "W/m^2",       "Surface",   IRRADIANCE,   0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_INDIRECT_LIGHT) \
  X(VOXEL_ALBEDO,       11, "voxel-albedo",        "Voxels: albedo",                       "",            "Voxels",    COLOR,        0.0f,   1.0f, CUBES,      FROM_FACETS) \
  X(VOXEL_NORMAL,       12, "voxel-normal",        "Voxels: normal",                       "",            "Voxels",    NORMAL,      -1.0f,   1.0f, CUBES,      FROM_FACETS) \
  X(VOXEL_EMISSION,     13, "voxel-emission",      "Voxels: emission M",                   "W/m^2",       "Voxels",    IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_FACETS) \
  X(VOXEL_IRRADIANCE,   14, "voxel-irradiance",    "Voxels: irradiance H",                 "W/m^2",       "Voxels",    IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_H) \
  X(FACET_COUNT,        15, "facet-count",         "Voxels: facets",                       "facets",      "Voxels",    SCALAR,       0.0f,   2.0f, CUBES,      FROM_FACETS) \
  X(DISTANCE,           16, "distance",            "Distance field in use",                "voxels",      "Distance",  SCALAR,       0.0f,   0.0f, PROJECTION, FROM_FIELD) \
  X(RADIOSITY,          17, "radiosity",           "Voxels: radiosity B",                  "W/m^2",       "Voxels",    IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_B) \
  X(ROW_OCCUPANCY,      18, "row-occupancy",       "Row entries / rays",                   "",            "Matrix",    SCALAR,       0.0f,   1.0f, CUBES,      FROM_MATRIX) \
  X(ROW_SUM,            19, "row-sum",             "Row sum of F",                         "",            "Matrix",    SCALAR,       0.0f,   1.0f, CUBES,      FROM_MATRIX) \
  X(INVALID_RAYS,       20, "invalid-rays",        "Invalid rays / rays",                  "",            "Matrix",    SCALAR,       0.0f,  0.25f, CUBES,      FROM_MATRIX) \
  X(EMITTER_IRRADIANCE, 21, "emitter-irradiance",  "Irradiance from emitters F M",         "W/m^2",       "Surface",   IRRADIANCE,   0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_EMITTED) \
  X(REFERENCE,          22, "reference",           "Voxels: irradiance H by the oracle",   "W/m^2",       "Voxels",    IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_ORACLE) \
  X(DISTANCE_CHEBYSHEV, 23, "distance-chebyshev",  "Chebyshev field",                      "voxels",      "Distance",  SCALAR,       0.0f,   0.0f, SLICE,      FROM_CHEBYSHEV) \
  X(DISTANCE_JFA,       24, "distance-jfa",        "Jump-flood field (8 bits)",            "voxels",      "Distance",  SCALAR,       0.0f,   0.0f, SLICE,      FROM_JFA) \
  X(JFA_SEEDS,          25, "jfa-seeds",           "Jump-flood seeds after a pass",        "",            "Distance",  SITE,         0.0f,   0.0f, SLICE,      FROM_JUMP_FLOOD) \
  X(JFA_ERROR,          26, "jfa-error",           "Error of the jump flood after a pass", "voxels",      "Distance",  SCALAR,       0.0f,   0.0f, SLICE,      FROM_JUMP_FLOOD | FROM_EXACT) \
  X(JFA_FIELD_ERROR,    27, "jfa-field-error",     "Error of the jump-flood field",        "voxels",      "Distance",  SIGNED,       0.0f,   0.0f, SLICE,      FROM_JFA | FROM_EXACT) \
  X(CHEBYSHEV_ERROR,    28, "chebyshev-error",     "Error of the Chebyshev field",         "voxels",      "Distance",  SIGNED,       0.0f,   0.0f, SLICE,      FROM_CHEBYSHEV | FROM_EXACT) \
  X(VOXEL_DIRECT,       29, "voxel-direct",        "Voxels: direct irradiance D",          "W/m^2",       "Voxels",    IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_D) \
  X(PIN_HOLES,          30, "pin-holes",           "Surface to the nearest solid voxel",   "voxels",      "Voxels",    SCALAR,       0.0f,   1.0f, NONE,       FROM_DEPTH | FROM_FACETS) \
  X(SHADOW_MAP,         31, "shadow-map",          "Shadow map of a light",                "m",           "Lights",    SCALAR,       0.0f,   0.0f, NONE,       FROM_SHADOW_MAPS) \
  X(SHADOW,             32, "shadow",              "Share of a light that arrives",        "",            "Lights",    SCALAR,       0.0f,   1.0f, NONE,       FROM_TARGETS | FROM_SHADOW_MAPS) \
  X(REFERENCE_PICTURE,  33, "reference-picture",   "Reference picture",                    "W/(m^2 sr)",  "Reference", LIGHT,        0.0f,   1.0f, NONE,       FROM_PICTURE) \
  X(ERROR,              34, "error",               "Relative error, signed",               "",            "Reference", SIGNED,      -0.5f,   0.5f, NONE,       FROM_TARGETS | FROM_PICTURE) \
  X(MATRIX_ROW,         35, "matrix-row",          "Matrix row: F to each facet",          "",            "Matrix",    SCALAR,       0.0f,   0.0f, CUBES,      FROM_MATRIX_ROW) \
  X(STANDARD_ERROR,     36, "standard-error",      "Voxels: standard error of H",          "W/m^2",       "Voxels",    SCALAR,       0.0f,   0.0f, CUBES,      FROM_STANDARD_ERROR) \
  X(WRITEBACK,          37, "writeback",           "Voxels: reflections written back W",   "W/m^2",       "Writeback", IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_WRITTEN | FROM_TARGETS | FROM_REFLECTIONS) \
  X(WRITEBACK_WRITERS,  38, "writeback-writers",   "Voxels: pixels that write back",       "pixels",      "Writeback", SCALAR,       0.0f,   2.0f, CUBES,      FROM_WRITTEN | FROM_TARGETS | FROM_REFLECTIONS) \
  X(WRITEBACK_MASK,     39, "writeback-mask",      "Pixels that the mask selects",         "",            "Writeback", COLOR,        0.0f,   1.0f, NONE,       FROM_TARGETS) \
  X(SKY_IRRADIANCE,     40, "sky-irradiance",      "Voxels: irradiance from the sky S",    "W/m^2",       "Voxels",    IRRADIANCE,   0.0f,   1.0f, CUBES,      FROM_SKY)
// clang-format on

#define IRAD_VIEW_CONSTANT(constant, number, name, label, unit, group, kind, low, high, shape, from) \
  IRAD_CONST uint VIEW_##constant = uint(number);
IRAD_VIEWS(IRAD_VIEW_CONSTANT)
#undef IRAD_VIEW_CONSTANT

IRAD_END
#endif
