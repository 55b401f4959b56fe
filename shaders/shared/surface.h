// The true surface by voxels (docs/method.md 4): which triangles have a piece in which voxel, and the facets that these
// pieces make up, each a class of points of one side of the surface.
#ifndef IRAD_SHARED_SURFACE_H
#define IRAD_SHARED_SURFACE_H
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

/// A facet's side: the triangle's back.
IRAD_CONST uint SURFEL_BACK = 0x80000000u;

/// A point of a facet's surface.
struct Surfel {
  uint triangle;  ///< | SURFEL_BACK
  uint place;     ///< weights of the second and third corner, 16-bit fractions
};
IRAD_ARRAY(SurfelArray, Surfel, 8)
/// Surfels of a facet: points that stand for equal shares of its area.
IRAD_CONST uint FACET_SURFELS = 8u;

IRAD_FN uint packPlace(vec2 weights) {
  vec2 q = clamp(weights, vec2(0.0f), vec2(1.0f)) * 65535.0f + vec2(0.5f);
  return uint(q.x) | (uint(q.y) << 16);
}
IRAD_FN vec2 unpackPlace(uint place) { return vec2(float(place & 0xFFFFu), float(place >> 16)) * (1.0f / 65535.0f); }

/// Which facet either side of a piece belongs to, counted from the voxel's first: front in bits 0-15, back in 16-31.
IRAD_CONST uint PIECE_BLACK = 0xFFFFu;  ///< none: the back of a single-sided face
IRAD_CONST uint PIECE_SPLIT = 0xFFFEu;  ///< several: the nearest surfel that is seen from the point decides

/// Links of a facet: a byte for each of the 3 x 3 x 3 voxels around (x + 3 y + 9 z): which of that voxel's facets
/// continues the surface on the same side, or NO_LINK.
IRAD_CONST uint FACET_LINKS = 7u;
IRAD_CONST uint NO_LINK = 255u;

struct SurfaceArrays {
  Vec3Array corners;      ///< three per triangle, voxel units
  UintArray firstPiece;   ///< per facet the first piece of its voxel; and, after the last facet, the number of pieces
  UintArray pieces;       ///< triangles, ascending within a voxel
  UintArray sides;        ///< per piece
  SurfelArray surfels;    ///< FACET_SURFELS per facet
  FloatArray area;        ///< per facet, voxel faces
  UintArray links;        ///< per facet FACET_LINKS words: the facets of the voxels around that go on on its side
};
IRAD_ARRAY(SurfaceRecord, SurfaceArrays, 16)

/// gi/link_facets.comp.
struct LinkFacetsPush {
  SurfaceRecord surface;
  UintArray voxel, reverse;
  UintArray links;
  uvec3 dims;
  uint count;
};

/// gi/blur_links.comp: H (and F M) averaged over linked facets, as shading samples them.
struct BlurLinksPush {
  SurfaceRecord surface;
  UintArray voxel, reverse;
  Vec4Array indirect, emitted;
  Vec4Array blurred, blurredEmitted;
  UintArray change;  ///< [0]: float bits of the largest |blurred - H|, W/m^2
  uvec3 dims;
  uint count;
};

/// gi/surface_corners.comp.
struct SurfaceCornersPush {
  SceneArray scene;
  GridArray grid;
  Vec3Array corners;
  uint triangles, pad;
};

/// gi/list_pieces.comp: counts the pieces of each voxel, or lists them.
struct ListPiecesPush {
  SceneArray scene;
  GridArray grid;
  UintArray tileStart;  ///< as for voxelization
  UintArray counts;     ///< per voxel: pieces; or the place of its next one
  UintArray pieces;     ///< unread where they are counted
  uint firstTriangle, endTriangle, firstTile, tileCount;
  uint lists, pad;
};

/// gi/solid_count.comp and gi/solid_emit.comp: voxels that have pieces, in Morton order.
struct SolidPush {
  GridArray grid;
  UintArray counts;       ///< per voxel: pieces; becomes the place of its first one
  UintArray blockSolid;   ///< per block of 64 voxels, then their exclusive prefix sums
  UintArray blockPieces;
  UintArray solid;        ///< packVoxel
  UintArray firstPiece;   ///< per solid voxel
  uint blocks, pad;
};

/// gi/sort_pieces.comp.
struct SortPiecesPush {
  UintArray solid;
  UintArray firstPiece;  ///< per solid voxel, and one more
  UintArray pieces, sorted;
  UintArray pieceVoxel;  ///< packVoxel
  uint count, pad;  ///< solid voxels
};

/// gi/piece_area.comp.
struct PieceAreaPush {
  UintArray pieceVoxel, pieces;
  Vec3Array corners;
  FloatArray area;  ///< per piece, voxel faces
  uint count, pad;  ///< pieces
};

/// gi/class_facets.comp: counts the facets of each solid voxel, or makes them.
struct ClassFacetsPush {
  SceneArray scene;
  GridArray grid;
  UintArray solid, firstPiece, pieces;
  FloatArray pieceArea;
  UintArray facetStart;  ///< per solid voxel: facets, or their exclusive prefix sum
  UintArray voxel, triangle, reverse;  ///< of FacetArrays
  SurfaceRecord surface;
  uint count;  ///< solid voxels
  uint makes;
};

/// gi/piece_shade.comp: albedo and exitance of each piece at its middle.
struct PieceShadePush {
  SceneArray scene;
  GridArray grid;
  UintArray order;  ///< pieces grouped by material; all that sample no texture are one group
  UintArray pieceVoxel;
  UintArray pieces;
  Vec3Array albedo;    ///< per piece, clamped to [0, .98]
  Vec3Array emission;  ///< M per piece
  UintArray clamped;   ///< [0]: pieces whose albedo had to be clamped
  uint first, count;   ///< this group, within `order`
  uint hasEmission, pad;
};

/// gi/facet_mean.comp: area-weighted attributes of each facet.
struct FacetMeanPush {
  SceneArray scene;
  SurfaceRecord surface;
  UintArray voxel, reverse;
  FloatArray pieceArea;
  Vec3Array pieceAlbedo, pieceEmission;
  UintArray shape;
  Uvec2Array albedo;
  Vec3Array emission;
  uvec3 dims;
  uint count;
  IRAD_AS(NormalEncoding) encoding;
  uint hasEmission;
};

IRAD_END
#endif
