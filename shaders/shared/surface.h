// The true surface by voxels (docs/method.md 4): which triangles have a piece in which voxel, and the facets that these
// pieces make up, each a class of points of one side of the surface.
#ifndef IRAD_SHARED_SURFACE_H
#define IRAD_SHARED_SURFACE_H
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/outer.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

/// A facet's side: the triangle's back.
IRAD_CONST uint SURFEL_BACK = 0x80000000u;

/// A point of a facet's surface.
struct Surfel {
  uint triangle;  ///< | SURFEL_BACK
  uint place;     ///< packPlace
};
/// Surfels of a facet: points that stand for equal shares of its area. They are kept as SURFEL_WORDS words: the place of
/// each, and a byte for each that says which side of which piece of the voxel it lies on (pieceSide).
IRAD_CONST uint FACET_SURFELS = 8u;
IRAD_CONST uint SURFEL_WORDS = FACET_SURFELS + FACET_SURFELS / 4u;
/// Where the voxel has more pieces than bytes can tell apart, the last word is this, and the one before it the facet's
/// place in SurfaceArrays::wideSides, where each has 16 bits.
IRAD_CONST uint WIDE_SIDES = 0xFFFFFFFFu;
IRAD_CONST uint MOST_NARROW = 127u;
IRAD_CONST uint WIDE_WORDS = FACET_SURFELS / 2u;
/// A side of a piece, `piece` counted from its voxel's first, of which there are MOST_PIECES at most.
IRAD_FN uint pieceSide(uint piece, bool back) { return 2u * piece + (back ? 1u : 0u); }

/// Rays of a facet of `area` voxel faces, of the `rays` that one voxel face and more has: the same for the same surface,
/// however it is divided. By whole subgroups, which end together.
IRAD_CONST uint LEAST_RAYS = 32u;
IRAD_FN uint facetRays(float area, uint rays) {
  uint share = uint(float(rays) * min(max(area, 0.0f), 1.0f));
  return min(rays, share / LEAST_RAYS * LEAST_RAYS + LEAST_RAYS);
}

/// The axis near a normal along which a piece of a triangle is seen: x and y before others that are hardly nearer, so
/// that rounding does not choose for faces at 45 degrees. A point is seen at its other two coordinates.
IRAD_FN uint seenAlong(vec3 normal) {
  vec3 n = abs(normal);
  return n.x >= 0.9f * max(n.y, n.z) ? 0u : (n.y >= 0.9f * n.z ? 1u : 2u);
}
IRAD_FN vec2 seenAt(vec3 v, uint axis) {
  return axis == 0u ? vec2(v.y, v.z) : (axis == 1u ? vec2(v.z, v.x) : vec2(v.x, v.y));
}
/// The point seen at `at` of the plane through `a`.
IRAD_FN vec3 onPlane(vec3 normal, vec3 a, vec2 at) {
  uint axis = seenAlong(normal);
  vec2 from = at - seenAt(a, axis), slope = seenAt(normal, axis);
  float up = axis == 0u ? a.x : (axis == 1u ? a.y : a.z);
  up -= (slope.x * from.x + slope.y * from.y) / (axis == 0u ? normal.x : (axis == 1u ? normal.y : normal.z));
  return axis == 0u ? vec3(up, at.x, at.y) : (axis == 1u ? vec3(at.y, up, at.x) : vec3(at.x, at.y, up));
}

/// Where a point of a piece is seen in its voxel, (0, 0) to (1, 1).
IRAD_FN uint packPlace(vec2 at) {
  vec2 q = clamp(at, vec2(0.0f), vec2(1.0f)) * 65535.0f + vec2(0.5f);
  return uint(q.x) | (uint(q.y) << 16);
}
IRAD_FN vec2 unpackPlace(uint place) { return vec2(float(place & 0xFFFFu), float(place >> 16)) * (1.0f / 65535.0f); }

/// Of a voxel with more pieces only the largest, at most as many, are taken to stand on others or to hide them: the work
/// grows with their number to the third power. The others' bit puts them last in the voxel's order.
IRAD_CONST uint MOST_LARGE = 32u;
IRAD_CONST uint PIECE_SMALL = 0x80000000u;
/// Voxels with more pieces than this have no large ones, and with more than MOST_PIECES they are refused.
IRAD_CONST uint MOST_COUNTED = 1024u;
IRAD_CONST uint MOST_PIECES = 16384u;

/// The box around a triangle's part in a voxel, in steps of 1/32 voxel, a little too large: `lo` and `hi` from the voxel's
/// lower corner. What passes it by need not ask the triangle.
IRAD_CONST float BOX_STEPS = 32.0f;
IRAD_CONST uint WHOLE_BOX = 0x3FFF8000u;
IRAD_FN uint packBox(vec3 lo, vec3 hi) {
  vec3 from = clamp(lo * BOX_STEPS - vec3(0.0625f), vec3(0.0f), vec3(BOX_STEPS - 1.0f));
  vec3 to = clamp(hi * BOX_STEPS + vec3(0.0625f), vec3(0.0f), vec3(BOX_STEPS - 1.0f));
  return uint(from.x) | (uint(from.y) << 5) | (uint(from.z) << 10) | (uint(to.x) << 15) | (uint(to.y) << 20) |
         (uint(to.z) << 25);
}

/// Pieces of a voxel, counted from its last one back, in groups with a box around each (SurfaceArrays::groups): of a crowd
/// most are passed by without a look at every piece.
IRAD_CONST uint PIECE_GROUP = 4u;
/// The place of the box around the group that begins with a piece: groups do not overlap, and in each there is one
/// multiple of PIECE_GROUP.
IRAD_FN uint groupPlace(uint piece) { return (piece + PIECE_GROUP - 1u) / PIECE_GROUP; }
/// Places of the groups of so many pieces.
IRAD_FN uint groupPlaces(uint pieces) { return groupPlace(pieces) + 1u; }
/// The packed box around two.
IRAD_FN uint boxAround(uint a, uint b) {
  uint around = 0u;
  for (uint shift = 0u; shift < 30u; shift += 5u) {
    uint x = (a >> shift) & 31u, y = (b >> shift) & 31u;
    around |= ((shift < 15u) == (x < y) ? x : y) << shift;
  }
  return around;
}

/// Corners, voxel units.
struct Triangle {
  vec3 a, b, c;
};
/// The unit normal of the side whose corners turn counter-clockwise, or of the other.
IRAD_FN vec3 facingOf(Triangle t, bool back) {
  vec3 n = normalize(cross(t.b - t.a, t.c - t.a));
  return back ? -n : n;
}

struct SurfelPoint {
  vec3 position, facing;  ///< voxel units
  uint triangle;
};
/// `t`: the surfel's triangle; `voxel`: of its facet.
IRAD_FN SurfelPoint surfelOn(Triangle t, Surfel s, uvec3 voxel) {
  SurfelPoint p;
  vec3 corner = vec3(voxel);
  p.position = corner + onPlane(cross(t.b - t.a, t.c - t.a), t.a - corner, unpackPlace(s.place));
  p.facing = facingOf(t, (s.triangle & SURFEL_BACK) != 0u);
  p.triangle = s.triangle & ~SURFEL_BACK;
  return p;
}
/// How far a ray starts above its triangle, as a share of the coordinates: eight times what these round to.
IRAD_CONST float START_LIFT = 8.0f / 16777216.0f;
IRAD_FN vec3 liftedStart(vec3 position, vec3 facing) {
  vec3 size = abs(position);
  return position + facing * (START_LIFT * max(1.0f, max(size.x, max(size.y, size.z))));
}
/// The same of a triangle that may reach far beyond the grid: by what the test of such a one rounds to, which is more
/// than its corners do.
IRAD_FN vec3 liftedFar(vec3 position, vec3 facing, Triangle t) {
  vec3 size = max(abs(t.a), max(abs(t.b), abs(t.c)));
  return position + facing * (8.0f * START_LIFT * max(1.0f, max(size.x, max(size.y, size.z))));
}

/// By how much later than it is the back of a face that does not show its back counts as met, in lengths of a ray's
/// direction: a face that lies in the same plane and shows its side wins, whatever the two distances round to. Both round
/// with the coordinates, of which the grid's size is the largest, and the more the flatter the ray; `cosine`: of the ray
/// and the face's normal, either sign.
IRAD_CONST float LEAST_COSINE = 1e-2f;
IRAD_FN float backDelay(uvec3 dims, float cosine) {
  return START_LIFT * float(max(dims.x, max(dims.y, dims.z))) / max(abs(cosine), LEAST_COSINE);
}

/// Which facet of its voxel either side of a piece belongs to: the front's in bits 0-7, the back's in 8-15.
IRAD_CONST uint PIECE_BLACK = 0xFFu;    ///< none: the back of a single-sided face
IRAD_CONST uint PIECE_UNKNOWN = 0xFEu;  ///< too small, or too close to where another triangle stands on it
/// Or, where others stand on it or it has an alpha mask, PIECE_CUT | the place in SurfaceArrays::cuts of: how many stand
/// on it (to MOST_CUTS), how many of its parts are known (cutCounts), | CUT_MASKED; with a mask two words, a bit for each
/// of MASK_EDGE x MASK_EDGE squares of the piece (maskBit) that is there; the triangles that stand on it; and its parts,
/// each with the sides of these triangles' planes on which it lies in bits 16-31 (gi/piece_cuts.h) above the facets
/// as for a whole piece. Parts are found by CUT_POINTS points of the piece. | CUT_SCREEN: the mask is the screen of a
/// blended surface, whose points stand for all of it, each with the share that is there.
IRAD_CONST uint PIECE_CUT = 0x80000000u;
IRAD_CONST uint CUT_MASKED = 0x80000000u;
IRAD_CONST uint CUT_SCREEN = 0x40000000u;
/// | CUT_TINTED: behind the mask's two words two more for each channel, a bit for each square that is closed to it: those of
/// the mask are closed to all three.
IRAD_CONST uint CUT_TINTED = 0x20000000u;
IRAD_CONST uint MASK_EDGE = 8u;
IRAD_CONST uint MOST_CUTS = 15u;
IRAD_CONST uint CUT_POINTS = 16u;
IRAD_FN uint cutHead(uint word) { return (word & CUT_MASKED) == 0u ? 1u : ((word & CUT_TINTED) == 0u ? 3u : 9u); }
IRAD_FN uint cutCounts(uint triangles, uint parts) { return triangles | (parts << 8); }
IRAD_FN uint cutTriangles(uint word) { return word & 0xFFu; }
IRAD_FN uint cutParts(uint word) { return (word >> 8) & 0xFFu; }
/// Parts that so many planes can divide a piece into, as far as points find them.
IRAD_FN uint mostParts(uint cuts) { return min(1u + cuts * (cuts + 1u) / 2u, CUT_POINTS); }
IRAD_CONST float CUT_WIDTH = 2e-3f;  ///< voxels: how close to a cut a point is on neither side
/// The bit of a piece's mask at a point relative to its voxel's lower corner; `normal`: the triangle's, of any length.
IRAD_FN uint maskBit(vec3 normal, vec3 point) {
  vec2 at = clamp(seenAt(point, seenAlong(normal)), vec2(0.0f), vec2(0.999f)) * float(MASK_EDGE);
  return uint(at.x) + MASK_EDGE * uint(at.y);
}
/// The middle of a bit's square on the plane of a triangle with corner `a` relative to the voxel's.
IRAD_FN vec3 maskPoint(vec3 normal, vec3 a, uint bit) {
  return onPlane(normal, a, (vec2(float(bit % MASK_EDGE), float(bit / MASK_EDGE)) + vec2(0.5f)) / float(MASK_EDGE));
}

/// The facets of a voxel are numbered from 0 to this.
IRAD_CONST uint LAST_CLASS = 61u;

/// A point by which the facets of a voxel are told apart: one for each side of a whole piece, CUT_POINTS of a cut one.
struct PiecePoint {
  vec3 position;  ///< voxel units
  uint side;      ///< the piece, | SURFEL_BACK
  float lift;     ///< clearAbove, of those that are compared with others
};
IRAD_ARRAY(PiecePointArray, PiecePoint, 4)
/// Its facet, counted from the voxel's first; | CLASS_LEADER: the point that the others of its class were compared with.
IRAD_CONST uint CLASS_LEADER = 0x80000000u;
IRAD_CONST uint NO_CLASS = 0x7FFFFFFFu;      ///< none, or not known yet
/// | k: that of point k of its side of the cut piece, the first one in the same part; CUT_POINTS: it is in none.
IRAD_CONST uint CLASS_OF_PART = 0x40000000u;
IRAD_FN bool isOfPart(uint class_) { return class_ >> 5 == CLASS_OF_PART >> 5; }

/// Links of a facet to those that continue the surface on the same side in the 3 x 3 x 3 voxels around (x + 3 y + 9 z): a
/// mask of the voxels that hold one, and for each of these, in turn, a byte: which of that voxel's facets. Its own voxel
/// is not among them.
IRAD_CONST uint OWN_VOXEL = 13u;
IRAD_ARRAY(LinkArray, uint8_t, 1)
/// As they are found: a byte for each voxel, or NO_LINK, and one without a meaning.
IRAD_CONST uint FACET_LINKS = 28u;
IRAD_CONST uint NO_LINK = 255u;

struct SurfaceArrays {
  Vec4Array corners;      ///< three per triangle, voxel units; w of the first: 1 where its back shows, else 0; of the
                          ///< second: 1 where a mask may have cut holes, 2 of a pane that tints, else 0; of the
                          ///< third: 1 + the triangle that it repeats (gi/repeated.h), else 0
  UintArray firstPiece;   ///< per facet the first piece of its voxel; and, after the last facet, the number of pieces
  UintArray pieces;       ///< triangles, | PIECE_SMALL, ascending within a voxel
  UintArray boxes;        ///< per piece: packBox
  UintArray groups;       ///< by groupPlace: boxAround a group's
  UintArray sides;        ///< per piece
  UintArray cuts;
  UintArray voxel;        ///< per facet, of FacetArrays
  UintArray surfels;      ///< SURFEL_WORDS per facet
  UintArray wideSides;    ///< WIDE_WORDS per facet of voxels with more than MOST_NARROW pieces
  FloatArray area;        ///< per facet, voxel faces
  UintArray linkMasks;    ///< per facet
  UintArray firstLinks;   ///< per facet: the place of its first byte in `links`; and the end
  LinkArray links;
  OuterRecord outer;      ///< what lies outside the grid; 0: nothing
};
IRAD_ARRAY(SurfaceRecord, SurfaceArrays, 16)

/// gi/piece_groups.comp.
struct PieceGroupsPush {
  UintArray firstPiece;  ///< per solid voxel, and the end
  UintArray boxes, groups;
  uint count;            ///< solid voxels
};

/// gi/link_points.comp.
struct LinkPointsPush {
  SurfaceRecord surface;
  UintArray reverse;
  Vec4Array points;  ///< FACET_SURFELS per facet: a surfel's position; w: how far above it ways begin
  uvec3 dims;
  uint count;        ///< facets
};

/// gi/link_facets.comp: as many facets a workgroup.
IRAD_CONST uint LINK_FACETS = 8u;
struct LinkFacetsPush {
  SurfaceRecord surface;
  UintArray voxel, reverse;
  Vec3Array facings;     ///< FacetSurfelsPush
  Vec4Array points;      ///< LinkPointsPush
  LinkArray found;       ///< FACET_LINKS per facet
  UintArray masks;
  UintArray counts;      ///< of links, per facet
  uvec3 dims;
  uint count;
};

/// gi/pack_links.comp.
struct PackLinksPush {
  LinkArray found;
  UintArray masks, firstLinks;
  LinkArray links;
  uint count, pad;  ///< facets
};

/// gi/blur_links.comp: H (and F M) averaged over linked facets as far as their noise goes, as shading samples them.
struct BlurLinksPush {
  SurfaceRecord surface;
  UintArray voxel, reverse;
  Vec4Array indirect, emitted;
  Vec4Array blurred, blurredEmitted;  ///< of emitted w: the variance of samples
  UintArray change;  ///< [0]: float bits of the largest |mean over the links - H|, W/m^2
  Vec4Array error;   ///< xyz: a vector as long as the standard error of H, W/m^2
  uvec3 dims;
  uint count;
};

/// gi/surface_corners.comp.
struct SurfaceCornersPush {
  SceneArray scene;
  GridArray grid;
  Vec4Array corners;
  UintArray repeated;  ///< per triangle, if hasRepeated
  uint triangles, hasRepeated;
};

/// gi/list_pieces.comp: counts the pieces of each voxel, or lists them.
struct ListPiecesPush {
  SceneArray scene;
  GridArray grid;
  Vec4Array corners;
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
  UintArray most;         ///< [0]: pieces of the voxel that has most
  uint blocks, pad;
};

/// gi/sort_pieces.comp.
struct SortPiecesPush {
  UintArray solid;
  UintArray firstPiece;  ///< per solid voxel, and one more
  UintArray pieces, sorted;
  UintArray pieceVoxel;  ///< which solid voxel
  Vec4Array corners;
  uint count, pad;  ///< solid voxels
};

/// gi/piece_shape.comp.
struct PieceShapePush {
  UintArray pieceVoxel, pieces;
  UintArray solid, firstPiece;
  Vec4Array corners;
  FloatArray area;    ///< per piece, voxel faces
  Vec3Array facings;  ///< per piece: the triangle's unit normal
  UintArray boxes;    ///< of SurfaceArrays
  UintArray points;   ///< per piece: PiecePoints
  UintArray cuts;     ///< per piece: words of SurfaceArrays::cuts
  uint count, pad;    ///< pieces
};

/// gi/piece_mask.comp.
struct PieceMaskPush {
  SceneArray scene;
  GridArray grid;
  UintArray order;  ///< pieces that have a mask, grouped by material
  UintArray pieceVoxel, solid;
  UintArray pieces, firstCut, cuts;
  uint first, count;  ///< this group, within `order`
};

/// gi/piece_points.comp.
struct PiecePointsPush {
  UintArray pieceVoxel, solid, firstPiece;
  SurfaceRecord surface;
  FloatArray area;
  UintArray firstPoint;  ///< per piece
  UintArray firstCut;    ///< per piece; and the end
  PiecePointArray points;
  UintArray classes;     ///< per point: NO_CLASS or CLASS_OF_PART
  UintArray sides, cuts;
  uint count, pad;  ///< pieces
};

/// gi/class_points.comp and gi/class_crowd.comp: which points of a voxel belong to one facet.
struct ClassPointsPush {
  UintArray solid;
  UintArray firstPiece;  ///< per solid voxel; and the end
  SurfaceRecord surface;
  FloatArray area;
  Vec3Array facings;     ///< per piece
  UintArray firstPoint;  ///< per piece; and the end
  PiecePointArray points;
  UintArray classes;     ///< per point
  UintArray facets;      ///< per solid voxel: how many
  UintArray wide;        ///< the same where there are more than MOST_NARROW pieces; else 0
  UintArray crowds;      ///< voxels that have more points than CROWD
  UintArray crowdCount;  ///< [0]: how many
  uint count, pad;       ///< solid voxels; class_crowd: crowds
};
/// Voxels with more points have a workgroup each, which compares about MOST_COMPARED of them; the others go with those.
IRAD_CONST uint CROWD = 32u;
IRAD_CONST uint MOST_COMPARED = 4096u;

/// gi/piece_sides.comp.
struct PieceSidesPush {
  GridArray grid;
  UintArray pieceVoxel, solid, firstPiece, firstPoint, classes;
  PiecePointArray points;
  FloatArray pieceArea;
  FloatArray pointArea;  ///< for how much of its facet's area a point stands, voxel faces
  UintArray facetStart;  ///< per solid voxel; and the end
  SurfaceRecord surface;
  UintArray voxel, reverse;  ///< of FacetArrays
  UintArray facetPiece;      ///< SurfaceArrays::firstPiece
  uint count, pad;
};

/// gi/facet_surfels.comp.
struct FacetSurfelsPush {
  SurfaceRecord surface;
  UintArray voxel, reverse, firstPoint, classes;
  PiecePointArray points;
  FloatArray pointArea;
  UintArray pieceVoxel;
  UintArray wideStart;  ///< per solid voxel: facets of wide voxels before it
  UintArray surfels, wideSides;
  Vec3Array facings;    ///< per facet: of the triangle that its middle surfel is on
  FloatArray area;
  uvec3 dims;
  uint count;
};

/// gi/piece_shade.comp: albedo, less what bumps take, and exitance of each piece.
struct PieceShadePush {
  SceneArray scene;
  GridArray grid;
  UintArray order;  ///< pieces grouped by material; all that sample no texture are one group
  UintArray pieceVoxel, solid;
  SurfaceRecord surface;
  Vec3Array albedo;    ///< per piece, in [0, .98]
  Vec3Array emission;  ///< M per piece
  UintArray clamped;   ///< [0]: pieces whose albedo had to be clamped
  uint first, count;   ///< this group, within `order`
  uint hasEmission, pad;
};

/// gi/facet_mean.comp: area-weighted attributes of each facet.
struct FacetMeanPush {
  SurfaceRecord surface;
  UintArray voxel, reverse;
  UintArray firstPoint, classes;
  PiecePointArray points;
  FloatArray pointArea;
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
