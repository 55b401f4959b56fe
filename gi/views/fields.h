// What views draw from beside the method's own products: the field that is not in use, the seeds after any pass of jump
// flooding, exact distances, a row of the matrix. Made on the device when a view first asks, out of one facet list.
#pragma once

#include <array>

#include "gi/settings.h"
#include "renderer/resources.h"

namespace irad {

class Frame;
struct FacetList;
struct Field;
struct FormFactors;

class ViewFields {
 public:
  /// A distance field as bytes, 4 voxels per uint, and what one step of a byte stands for.
  struct Bytes {
    const Buffer& buffer;
    float voxelsPerStep;
  };
  /// `inUse` is read where it was made by that method.
  Bytes bytes(Frame& frame, const FacetList& facets, const Field* inUse, FieldMethod method);
  /// recordJumpFlood's, after the first `passes` passes or the last.
  const Buffer& seeds(Frame& frame, const FacetList& facets, uint32_t passes);
  /// One uint per voxel: distance to the nearest solid voxel by METRIC_* (squared where Euclidean), or NO_DISTANCE.
  const Buffer& exact(Frame& frame, const FacetList& facets, uint32_t metric);
  /// vec4 per facet: F to it from facet `row`, of the matrix as it is now.
  const Buffer& row(Frame& frame, const FormFactors& matrix, uint32_t row);

 private:
  const Buffer& grid(Frame& frame, const FacetList& facets);

  Buffer grid_, chebyshev_, jfa_, seeds_, row_;
  uint32_t seedPasses_ = 0;
  std::array<Buffer, 2> exact_;  ///< by metric
};

}  // namespace irad
