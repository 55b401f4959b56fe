// Push constants of what `irad check` asks the device of shared functions (shaders/check).
#ifndef IRAD_SHARED_CHECK_H
#define IRAD_SHARED_CHECK_H
#include "shared/normals.h"
IRAD_BEGIN

/// check/encode.comp: normals there and back.
struct EncodePush {
  Vec4Array normals;
  Vec4Array decoded;
  uint count;
  IRAD_AS(NormalEncoding) encoding;
};

/// check/sample.comp: one point of each of many sets, and the direction it gives.
struct SamplePush {
  Uvec4Array points;       ///< x: k, y: n, zw: shift (hammersley)
  Vec4Array coordinates;  ///< xy
  Vec4Array directions;   ///< xyz, about `normal`
  vec3 normal;
  uint count;
};

IRAD_END
#endif
