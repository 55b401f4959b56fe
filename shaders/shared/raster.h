// Rasterization by compute kernels (shaders/raster/raster.glsl, renderer/raster.h).
#ifndef IRAD_SHARED_RASTER_H
#define IRAD_SHARED_RASTER_H
#include "shared/passes.h"
IRAD_BEGIN

/// Specialization constants of every rasterizing kernel.
IRAD_CONST uint RASTER_TILES = 8u;   ///< second pass: tiles of the triangles that the first has set aside
IRAD_CONST uint RASTER_MASKED = 9u;  ///< the alpha of the bound material decides

/// Pixels of a triangle's bounds up to which one invocation draws it by itself.
IRAD_CONST int RASTER_SMALL = 16;
/// The others are cut into tiles of (32 << level)^2 pixels, masked ones, which wait for their textures, of half that;
/// level the least for which this many suffice (fewer where the queue holds so many pieces that a uint could not count
/// their tiles).
IRAD_CONST int RASTER_TILE_BITS = 5;
IRAD_CONST uint RASTER_TILES_PER_PIECE = 1024u;
/// Pixels squared within which edge functions fit 32 bits, in pictures of up to 16,384 pixels and RASTER_GUARD.
IRAD_CONST int RASTER_BLOCK = 32;
/// Corners further than this many half-pictures off the axis are clipped.
IRAD_CONST float RASTER_GUARD = 4.0f;
/// Invocations of a workgroup, those that share a tile, and workgroups of the second pass, which take tiles in turn.
IRAD_CONST uint RASTER_WORKGROUP = 128u;
IRAD_CONST uint RASTER_LANES = 32u;
IRAD_CONST uint RASTER_GROUPS = 4096u;

/// A triangle, or what clipping has left of it, ready to be scanned.
struct RasterPiece {
  ivec2 a, b, c;     ///< corners, 1/256 pixel, y down; clockwise to the eye
  float da, db, dc;  ///< their depths
  uint triangle;
};
IRAD_CONST uint RASTER_PIECE_BYTES = 40u;
/// A piece of more than one tile: where the others begin, in the row of all such tiles.
struct RasterRest {
  uint piece;
  uint firstTile;  ///< ascending
};
/// The queue: counts of the opaque and of the masked, 0 at first; then of either kind the pieces set aside, as many as it
/// holds, and their RasterRests, as many at most.
IRAD_CONST uint RASTER_REST_BYTES = 8u;
IRAD_CONST uint RASTER_COUNTS_BYTES = 32u;
IRAD_FN uint64_t rasterPartBytes(uint pieces) { return uint64_t(pieces) * (RASTER_PIECE_BYTES + RASTER_REST_BYTES); }
struct RasterCount {
  uint64_t rests;  ///< tiles but the pieces' first ones; above them (<< 32) the number of pieces that have such
  uint pieces;     ///< all
  uint padding;
};
IRAD_ARRAY(RasterQueue, RasterCount, 8)
IRAD_ARRAY(RasterPieces, RasterPiece, 4)
IRAD_ARRAY(RasterRests, RasterRest, 4)
#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer VisibleArray { uint64_t at[]; };
#endif

/// raster/shadow.comp and raster/visible.comp.
struct RasterPush {
  SceneArray scene;
  ProjectionArray projection;  ///< local position -> clip
  RasterQueue queue;
  UintArray target;  ///< a word, or two, per pixel
  uvec2 size;        ///< pixels
  uint first, end;   ///< triangles
  uint pieces;       ///< that the queue holds
  uint cull;         ///< 1: not the backs of single-sided materials
  uint skipMasked;   ///< 1: not those of masked materials
  uint peels;        ///< 1: blended materials behind `peeled` alone
  UintArray peeled;  ///< as `target`
  uint channel;      ///< shadow maps: by which panes keep light off
  uint padding;
};

/// raster/store_shadow.comp.
struct StoreShadowPush {
  UintArray words;
  int layer;
  uint padding;
};

/// raster/shadow_moments.comp: a layer, or a face of a cube.
struct ShadowMomentsPush {
  int layer, face;
  uint taps;        ///< texels per axis that a mean is over, odd
  float nearShare;  ///< near / far of a map in perspective; 0: a parallel one
};

IRAD_END
#endif
