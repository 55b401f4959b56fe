// Push constants and records of the passes that draw views (gi/view_*.cpp).
#ifndef IRAD_SHARED_VIEW_H
#define IRAD_SHARED_VIEW_H
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/matrix.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

/// view/debug_view.comp: over the targets of the forward pass.
struct ViewPush {
  CameraArray camera;
  uint kind;
  float exposure;  ///< linear factor
  uint toneCurve;
};

// How a volume is shown (view.shape, resolved).
IRAD_CONST uint SHAPE_CUBES = 0u;
IRAD_CONST uint SHAPE_SLICE = 1u;
IRAD_CONST uint SHAPE_PROJECTION = 2u;
IRAD_CONST uint SHAPE_ISOSURFACE = 3u;

// view.axis: x, y, z, or the one that the camera looks along most.
IRAD_CONST uint AXIS_OF_CAMERA = 3u;

/// view/voxel_view.comp: values of voxels. Addresses that a view does not read are 0.
struct VoxelViewPush {
  CameraArray camera;
  Grid grid;
  FacetRecord facets;
  MatrixRecord matrix;  ///< 0: there is none
  Vec4Array values;     ///< per facet: H, B, D or F, as the view has it; 0: there are none
  UintArray bytes;      ///< a distance field, 4 voxels per uint
  UintArray seeds;      ///< packVoxel of a solid voxel, or NO_SEED
  UintArray exact;      ///< exact distance (view/exact_distance.comp)
  uint axis;        ///< of a slice
  float slice;      ///< 0..1
  float isovalue;   ///< voxels
  float byteScale;  ///< voxels that one step of `bytes` stands for
  uint row;         ///< packRow
};
IRAD_FN uint packRow(uint rays, uint padded, uint normalEncoding) {
  return rays | (padded << 16) | (normalEncoding << 17);
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

// view.range
IRAD_CONST uint RANGE_STANDARD = 0u;
IRAD_CONST uint RANGE_AUTO = 1u;
IRAD_CONST uint RANGE_PERCENTILE = 2u;
IRAD_CONST uint RANGE_MANUAL = 3u;

/// view/range_measure.comp and view/range_resolve.comp.
struct RangePush {
  ViewRangeArray range;
  UintArray bins;
  uvec2 size;  ///< pixels
  uint kind;
  uint mode;  ///< RANGE_AUTO, RANGE_PERCENTILE or RANGE_MANUAL
  float low, high;   ///< RANGE_MANUAL
  float percentile;  ///< the upper one, 50..100
};

/// view/finish.comp: from the linear to the display picture, where that needs the range or the scene around.
struct FinishPush {
  ViewRangeArray range;
  uvec2 size;
  uint kind;
  uint colorMap;
  float exposure;
  uint toneCurve;
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
