// The specialization constants of the shaders, by one name in both languages; each has a number of its own, so that a
// shader may be put together from any pieces. The constants of lights that are gathered and of the rasterizing kernels
// are declared with these (shared/solve.h, shared/raster.h) and have lower numbers; those of "RE Forward"
// (shared/passes.h) begin at 64, so that a kind of light may come.
#ifndef IRAD_SHARED_CONSTANTS_H
#define IRAD_SHARED_CONSTANTS_H
#include "shared/types.h"
IRAD_BEGIN

// Facets.
IRAD_CONST uint CONSTANT_NORMALS = 18u;           ///< how their normals are encoded
IRAD_CONST uint CONSTANT_SAMPLES_TEXTURES = 19u;  ///< gi/voxel_material.glsl
IRAD_CONST uint CONSTANT_MATERIAL_FLAGS = 57u;    ///< likewise
IRAD_CONST uint CONSTANT_CLIPS_SHARED = 22u;      ///< gi/voxel_clip.h

// Rays through the voxels (gi/trace.glsl).
IRAD_CONST uint CONSTANT_TRACE_METHOD = 20u;
IRAD_CONST uint CONSTANT_TRACE_HIT_RULE = 21u;
IRAD_CONST uint CONSTANT_TRACE_EMITTERS = 23u;  ///< specular/trace.glsl
IRAD_CONST uint CONSTANT_JITTER = 17u;          ///< each facet has a ray set of its own (matrix.jitter)
IRAD_CONST uint CONSTANT_FEW_RAYS = 26u;        ///< gi/waiting_rays.glsl
IRAD_CONST uint CONSTANT_RESUMES = 27u;         ///< gi/trace_triangle_rays.comp
/// There are panes that tint: rows tell what those on the way have let through (openChannels), and what looks up
/// materials of pieces has code for them (gi/voxel_material.glsl).
IRAD_CONST uint CONSTANT_TINTED = 25u;
IRAD_CONST uint CONSTANT_OUTER = 56u;          ///< there are triangles outside the grid
IRAD_CONST uint CONSTANT_SKY = 24u;             ///< there is a sky: of whatever knows one

// The matrix and what is made of it.
IRAD_CONST uint CONSTANT_MATRIX_FORMAT = 30u;
IRAD_CONST uint CONSTANT_SLICE = 31u;            ///< thesis/padded_rows.comp: rays of one dispatch
IRAD_CONST uint CONSTANT_MERGE_WORKGROUP = 32u;  ///< gi/merge_rows.comp: its size
IRAD_CONST uint CONSTANT_SORTED = 33u;           ///< gi/merge_rows.comp
IRAD_CONST uint CONSTANT_SOLVE_WORK = 34u;
IRAD_CONST uint CONSTANT_SCATTER_STORES = 35u;
IRAD_CONST uint CONSTANT_BLUR_WEIGHS = 29u;    ///< gi/blur_links.comp
IRAD_CONST uint CONSTANT_EMITTED = 36u;        ///< F M too, beside H
IRAD_CONST uint CONSTANT_SOLVE_VECTORS = 37u;  ///< gi/solve_sums.comp, gi/extrapolate.comp: n
IRAD_CONST uint CONSTANT_REFLECTED = 38u;      ///< there is light written back, W
IRAD_CONST uint CONSTANT_BY_HOST = 28u;        ///< gi/sample_emitters.comp: the host has traced the samples
IRAD_CONST uint CONSTANT_FRAMES = 39u;         ///< light by brute force: there is no matrix

// Pictures.
IRAD_CONST uint CONSTANT_VIEW = 40u;
IRAD_CONST uint CONSTANT_VIEW_SHAPE = 41u;
IRAD_CONST uint CONSTANT_VIEW_FROM = 51u;       ///< FROM_*: what it is drawn from
IRAD_CONST uint CONSTANT_TARGETS = 42u;         ///< those that are there
IRAD_CONST uint CONSTANT_KEEPS_POSITION = 43u;  ///< gi/indirect_links.comp
IRAD_CONST uint CONSTANT_SEEKS = 52u;           ///< gi/indirect_links.comp
IRAD_CONST uint CONSTANT_SOUGHT_LANES = 53u;    ///< gi/sought_facet.glsl
IRAD_CONST uint CONSTANT_LOBE_LANES = 54u;      ///< specular/trace.glsl
IRAD_CONST uint CONSTANT_LOBE_WORKGROUP = 55u;  ///< specular/trace.comp: its size, PICKED_GROUP x LOBE_LANES
IRAD_CONST uint CONSTANT_LIST_PIXELS = 44u;     ///< forward/list_pixels.comp: write the lists, not count
IRAD_CONST uint CONSTANT_DISTANCE_METRIC = 45u;
IRAD_CONST uint CONSTANT_FILTERED = 46u;     ///< specular/classify.comp
IRAD_CONST uint CONSTANT_FILTER_STEP = 47u;  ///< these three: specular/filter.comp
IRAD_CONST uint CONSTANT_FILTER_RESOLVE = 48u;
IRAD_CONST uint CONSTANT_LEAST_ROUGHNESS = 49u;
IRAD_CONST uint CONSTANT_HAS_INDIRECT = 50u;  ///< view/finish.comp: there is such a target

IRAD_END
#endif
