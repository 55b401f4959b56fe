// Kernels of the surface's list whose work differs from invocation to invocation, run by the host on all cores: for CPU
// devices, whose driver goes through all branches of eight invocations at a time. They take the kernels' push
// constants, whose addresses are of host memory (gi/host_pass.h), and share the kernels' functions (shaders/gi).
#pragma once

#include "shaders/shared/surface.h"

namespace irad {

/// gi/list_pieces.comp, of the triangles from push.firstTriangle on; there are no tiles.
void listPiecesOnHost(const ListPiecesPush& push);
/// gi/sort_pieces.comp.
void sortPiecesOnHost(const SortPiecesPush& push);
/// gi/piece_shape.comp.
void shapePiecesOnHost(const PieceShapePush& push);
/// gi/piece_points.comp.
void findPointsOnHost(const PiecePointsPush& push, const SurfaceArrays& surface);
/// gi/class_points.comp and gi/class_crowd.comp, which between them take every voxel; its crowds are not read.
void classPointsOnHost(const ClassPointsPush& push, const SurfaceArrays& surface);
/// gi/piece_sides.comp.
void findSidesOnHost(const PieceSidesPush& push, const SurfaceArrays& surface);
/// gi/facet_surfels.comp.
void placeSurfelsOnHost(const FacetSurfelsPush& push, const SurfaceArrays& surface);
/// gi/link_points.comp, which makes push.points, and gi/link_facets.comp.
void linkFacetsOnHost(const LinkFacetsPush& push, const SurfaceArrays& surface);
/// gi/facet_mean.comp.
void meanFacetsOnHost(const FacetMeanPush& push, const SurfaceArrays& surface);

}  // namespace irad
