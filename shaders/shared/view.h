// Push constants and records of the passes that draw views (gi/views/).
#ifndef IRAD_SHARED_VIEW_H
#define IRAD_SHARED_VIEW_H
#include "shared/color_map.h"
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/matrix.h"
#include "shared/normals.h"
#include "shared/scene_gpu.h"
#include "shared/sky.h"
IRAD_BEGIN

/// view/debug_view.comp: over the targets of the forward pass.
struct ViewPush {
  CameraArray camera;
  SkyRecord sky;  ///< behind the scene, where there is one
  uint kind;
  uint linearOnly;  ///< 1: view/finish.comp makes the display picture
  float exposure;   ///< linear factor
  IRAD_AS(ToneCurve) toneCurve;
  vec3 origin;  ///< these two: of the Grid
  float inverseEdge;
  WritebackParams writeback;
};

// clang-format off
// How a volume is shown (view.shape); a view is drawn as one of the first four.
#define IRAD_VIEW_SHAPES(X, E) \
  X(E, cubes,      "cubes",      SHAPE_CUBES,      0) \
  X(E, slice,      "slice",      SHAPE_SLICE,      1) \
  X(E, projection, "projection", SHAPE_PROJECTION, 2) \
  X(E, isosurface, "isosurface", SHAPE_ISOSURFACE, 3) \
  X(E, automatic,  "auto",       SHAPE_AUTO,       4)
IRAD_SHARED_ENUM(ViewShape, IRAD_VIEW_SHAPES)

// automatic: the axis that the camera looks along most.
#define IRAD_AXES(X, E) \
  X(E, x,         "x",    AXIS_X,         0) \
  X(E, y,         "y",    AXIS_Y,         1) \
  X(E, z,         "z",    AXIS_Z,         2) \
  X(E, automatic, "auto", AXIS_OF_CAMERA, 3)
IRAD_SHARED_ENUM(Axis, IRAD_AXES)

// What the ends of a colour map stand for (view.range).
#define IRAD_RANGE_MODES(X, E) \
  X(E, standard,   "standard",   RANGE_STANDARD,   0) \
  X(E, automatic,  "auto",       RANGE_AUTO,       1) \
  X(E, percentile, "percentile", RANGE_PERCENTILE, 2) \
  X(E, manual,     "manual",     RANGE_MANUAL,     3)
IRAD_SHARED_ENUM(RangeMode, IRAD_RANGE_MODES)
// clang-format on

/// view/voxel_view.comp: values of voxels. Addresses that a view does not read are 0.
struct VoxelViewPush {
  CameraArray camera;
  Grid grid;
  FacetRecord facets;
  MatrixRecord matrix;  ///< 0: there is none
  Vec4Array values;     ///< per facet: H, B, D, W or F, as the view has it; 0: there are none
  UintArray bytes;      ///< a distance field, 4 voxels per uint
  UintArray seeds;      ///< packVoxel of a solid voxel, or NO_SEED
  UintArray exact;      ///< exact distance (view/exact_distance.comp)
  IRAD_AS(Axis) axis;  ///< of a slice
  float slice;      ///< 0..1
  float isovalue;   ///< voxels
  float byteScale;  ///< voxels that one step of `bytes` stands for
  uint row;         ///< packRow
};
IRAD_FN uint packRow(uint rays, uint padded, IRAD_AS(NormalEncoding) normalEncoding) {
  return rays | (padded << 16) | (uint(normalEncoding) << 17);
}

/// view/exact_distance.comp: along one axis after another.
struct ExactDistancePush {
  GridArray grid;
  UintArray reverse;
  UintArray source;  ///< of the axis before
  UintArray target;
  uint axis;
};
// Its metric, specialization constant 0.
IRAD_CONST uint METRIC_EUCLIDEAN = 0u;  ///< squared
IRAD_CONST uint METRIC_CHEBYSHEV = 1u;
IRAD_CONST uint NO_DISTANCE = 0xFFFFFFFFu;  ///< nothing is solid

/// The values of a view with a range, and the range that it is drawn with. Values of signed views count by magnitude.
/// Floats >= 0 as bits: the same whatever the order.
struct ViewRange {
  uint least, most;  ///< of the finite values; least > most: there are none
  uint drawn;        ///< how many those are
  uint nan, infinite, negative;  ///< pixels that are marked instead
  float low, high;   ///< shown with the map's ends
};
IRAD_ARRAY(ViewRangeArray, ViewRange, 4)

/// Percentiles come from a histogram over the upper 16 bits below the sign: bins 2^-8 of their values wide, whatever the
/// values' scale.
IRAD_CONST uint RANGE_BINS = 65536u;
IRAD_CONST uint RANGE_BIN_SHIFT = 15u;

/// view/range_measure.comp and view/range_resolve.comp.
struct RangePush {
  ViewRangeArray range;
  UintArray bins;
  uvec2 size;  ///< pixels
  uint kind;
  IRAD_AS(RangeMode) mode;  ///< RANGE_AUTO, RANGE_PERCENTILE or RANGE_MANUAL
  float low, high;   ///< RANGE_MANUAL
  float percentile;  ///< the upper one, 50..100
};

IRAD_CONST uint HISTOGRAM_BINS = 256u;
IRAD_CONST uint HISTOGRAM_CHANNELS = 4u;  ///< red, green, blue, luminance; of views of one value the last one alone
IRAD_CONST uint HISTOGRAM_COUNTS = HISTOGRAM_CHANNELS * HISTOGRAM_BINS;
/// How often values occur in a picture, in bins of one width.
struct Histogram {
  float low, high;    ///< values that the first bin begins and the last one ends with
  uint below, above;  ///< pixels whose luminance lies beyond
  uint counts[HISTOGRAM_COUNTS];  ///< pixels, channel after channel
};
IRAD_ARRAY(HistogramArray, Histogram, 4)

/// view/histogram.comp
struct HistogramPush {
  ViewRangeArray values;  ///< what is there
  ViewRangeArray shown;   ///< that the picture was drawn with; 0: none
  HistogramArray histogram;
  uvec2 size;  ///< pixels
  uint kind;
  uint fixedAxis;    ///< 1: the axis is the next two
  float low, high;
};

/// camera.auto_exposure: the luminance that this share of the picture stays below is shown as bright as this, where the
/// neutral tone curve begins to bend; of a picture that is black up to there, its brightest.
IRAD_CONST float AUTO_EXPOSURE_PERCENTILE = 95.0f;
IRAD_CONST float AUTO_EXPOSURE_LEVEL = 0.76f;
/// The factor that brings it there; `range`: of luminances.
IRAD_FN float autoExposure(ViewRange range) {
  float level = range.high > 0.0f ? range.high : uintBitsToFloat(range.most);
  if (!(level > 0.0f)) return 1.0f;
  return clamp(AUTO_EXPOSURE_LEVEL / level, 1e-12f, 1e12f);
}

/// view/finish.comp: from the linear to the display picture, where that needs the range or the scene around.
struct FinishPush {
  ViewRangeArray range;
  uvec2 size;
  uint kind;
  IRAD_AS(ColorMap) colorMap;
  uint automatic;  ///< 1: times autoExposure(range)
  float exposure;
  IRAD_AS(ToneCurve) toneCurve;
  uvec3 dims;  ///< of the grid that sites are of
  uint surroundings;  ///< 1: where nothing is drawn the lit scene shows, dimmed
};

/// view/matrix_row.comp: a row of the matrix, spread out over the facets.
struct MatrixRowPush {
  MatrixRecord matrix;
  Vec4Array factors;  ///< per facet: F to it from facet `row`
  uint row;
  uint pad;
};

/// view/pin_holes.comp
struct PinHolePush {
  CameraArray camera;
  Grid grid;
  UintArray reverse;
};

/// view/shadow_map.comp and view/shadow.comp: one light.
struct ShadowViewPush {
  LightArray lights;
  CameraArray camera;
  uint light;  ///< index
  uvec2 size;
  float shadowBias;  ///< texels
  uint pcf;
};

/// view/difference.comp
struct DifferencePush {
  uvec2 size;  ///< pixels
  uint kind;   ///< of the view that both pictures show
};

/// view/reference.comp, pixels.
struct ReferencePush {
  uvec2 size, referenceSize;
};
/// Signed relative error of a pixel, L and R the luminances of picture and reference: (L - R) / sqrt(R^2 + epsilon). Its
/// mean square is relMSE.
IRAD_CONST float VIEW_ERROR_EPSILON = 0.01f;

IRAD_END
#endif
