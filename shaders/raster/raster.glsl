// Rasterization by a compute kernel, by the graphics pipeline's rules: corners snapped to 1/256 pixel, exact edge
// functions (Pineda 1988, "A Parallel Algorithm for Polygon Rasterization"), shared edges drawn once (top-left rule),
// depth affine in the picture, clip space with y up. A first pass gives each triangle an invocation, which draws small
// ones and sets the others aside; in a second one invocations share those, tile by tile (as Laine and Karras 2011,
// "High-Performance Software Rasterization on GPUs", and Nanite part small from large).
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shared/raster.h"

layout(local_size_x = RASTER_WORKGROUP) in;
layout(constant_id = RASTER_TILES) const bool TILES = false;

struct RasterJob {
  RasterQueue queue;
  uint kind;        ///< 0: opaque, 1: masked
  uint pieces;      ///< that the queue holds of either kind
  uvec2 size;       ///< pixels
  uint first, end;  ///< triangles
};

// From the including shader.
RasterJob rasterJob();
/// Corners in clip space, and whether triangles that show their back (clockwise) are left out. False: nothing to draw.
bool rasterCorners(uint triangle, out vec4 corners[3], out bool cull);
/// The pixels to come are this triangle's.
void rasterBegin(uint triangle);
void rasterPixel(uint triangle, ivec2 pixel, float depth);

const int CLIP_PLANES = 6;

/// >= 0 inside.
float clipDistance(vec4 c, int plane) {
  switch (plane) {
    case 0: return c.z;
    case 1: return c.w - c.z;
    case 2: return RASTER_GUARD * c.w - c.x;
    case 3: return RASTER_GUARD * c.w + c.x;
    case 4: return RASTER_GUARD * c.w - c.y;
    default: return RASTER_GUARD * c.w + c.y;
  }
}

bool needsNoClip(vec4 c) {
  return c.z >= 0.0 && c.z <= c.w && max(abs(c.x), abs(c.y)) <= RASTER_GUARD * c.w;
}

bool outOfPicture(vec4 a, vec4 b, vec4 c) {
  vec3 w = vec3(a.w, b.w, c.w);
  vec3 x = vec3(a.x, b.x, c.x), y = vec3(a.y, b.y, c.y), z = vec3(a.z, b.z, c.z);
  return all(greaterThan(x, w)) || all(lessThan(x, -w)) || all(greaterThan(y, w)) || all(lessThan(y, -w)) ||
         all(greaterThan(z, w)) || all(lessThan(z, vec3(0.0)));
}

/// 1/256 pixels, y down.
ivec2 snapped(vec4 c, uvec2 size) {
  precise vec2 ndc = c.xy / c.w;
  precise vec2 at = (ndc * vec2(0.5, -0.5) + 0.5) * vec2(size) * 256.0;
  return ivec2(floor(at + 0.5));
}

/// Twice the area of p, q, r, positive if they turn clockwise to the eye.
int64_t turn(ivec2 p, ivec2 q, ivec2 r) {
  return int64_t(q.x - p.x) * int64_t(r.y - p.y) - int64_t(q.y - p.y) * int64_t(r.x - p.x);
}

/// Least value of the edge function p, q of a pixel that belongs to the triangle: one on a top or left edge does.
int64_t leastInside(ivec2 p, ivec2 q) {
  return q.y < p.y || (q.y == p.y && q.x > p.x) ? int64_t(0) : int64_t(1);
}

/// False: nothing of it is seen.
bool setUp(uint triangle, vec4 ca, vec4 cb, vec4 cc, bool cull, uvec2 size, out RasterPiece p) {
  p.triangle = triangle;
  p.a = snapped(ca, size);
  p.b = snapped(cb, size);
  p.c = snapped(cc, size);
  precise float da = ca.z / ca.w;
  precise float db = cb.z / cb.w;
  precise float dc = cc.z / cc.w;
  int64_t area = turn(p.a, p.b, p.c);
  bool back = area > 0;
  ivec2 b = p.b;
  p.b = back ? b : p.c;
  p.c = back ? p.c : b;
  p.da = da;
  p.db = back ? db : dc;
  p.dc = back ? dc : db;
  return area != 0 && !(cull && back);
}

/// Pixels whose centres the piece's bounds hold: first xy, last zw.
ivec4 bounds(RasterPiece p, uvec2 size) {
  ivec2 lo = min(p.a, min(p.b, p.c)), hi = max(p.a, max(p.b, p.c));
  return ivec4(max((lo + 127) >> 8, ivec2(0)), min((hi - 128) >> 8, ivec2(size) - 1));
}

/// The edge function p, q about a block of pixels whose first has the middle `at`, in 1/256 of its unit: between pixels
/// it changes by whole numbers, so that its sign there is exact. Beyond what may come to 0 within the block it is cut off.
struct Edge {
  int first;  ///< >= 0 inside
  ivec2 step;
};
Edge edge(int64_t value, ivec2 p, ivec2 q) {
  const int64_t most = int64_t(1) << 30;
  return Edge(int(clamp((value - leastInside(p, q)) >> 8, -most, most)), ivec2(p.y - q.y, q.x - p.x));
}
int edgeAt(Edge e, ivec2 pixel) { return e.first + e.step.x * pixel.x + e.step.y * pixel.y; }
/// Whether none of the pixels up to `last` is inside.
bool edgeLeavesOut(Edge e, ivec2 last) { return edgeAt(e, mix(ivec2(0), last, greaterThan(e.step, ivec2(0)))) < 0; }

/// The piece's pixels within `box`, a block at most, from `start` on in steps. One loop, not two: invocations side by side
/// with boxes of other shapes would wait for each other in either.
void scanBlock(RasterPiece p, ivec4 box, ivec2 start, ivec2 stride) {
  ivec2 last = box.zw - box.xy;
  ivec2 at = box.xy * 256 + 128;
  int64_t firstB = turn(p.c, p.a, at), firstC = turn(p.a, p.b, at);
  Edge a = edge(turn(p.b, p.c, at), p.b, p.c), b = edge(firstB, p.c, p.a), c = edge(firstC, p.a, p.b);
  if (edgeLeavesOut(a, last) || edgeLeavesOut(b, last) || edgeLeavesOut(c, last)) return;
  precise float inverseArea = 1.0 / float(turn(p.a, p.b, p.c));
  ivec2 pixel = start;
  while (pixel.y <= last.y) {
    if (pixel.x <= last.x && (edgeAt(a, pixel) | edgeAt(b, pixel) | edgeAt(c, pixel)) >= 0) {
      precise float toB = float(firstB + 256 * (int64_t(b.step.x) * pixel.x + int64_t(b.step.y) * pixel.y)) * inverseArea;
      precise float toC = float(firstC + 256 * (int64_t(c.step.x) * pixel.x + int64_t(c.step.y) * pixel.y)) * inverseArea;
      precise float depth = p.da + (toB * (p.db - p.da) + toC * (p.dc - p.da));
      rasterPixel(p.triangle, box.xy + pixel, clamp(depth, 0.0, 1.0));
    }
    pixel.x += stride.x;
    if (pixel.x > last.x) pixel = ivec2(start.x, pixel.y + stride.y);
  }
}

/// The piece's pixels within `box`, from `start` in each block on in steps.
void scan(RasterPiece p, ivec4 box, ivec2 start, ivec2 stride) {
  for (int y = box.y; y <= box.w; y += RASTER_BLOCK)
    for (int x = box.x; x <= box.z; x += RASTER_BLOCK)
      scanBlock(p, ivec4(x, y, min(box.zw, ivec2(x, y) + (RASTER_BLOCK - 1))), start, stride);
}

/// How many tiles a box is cut into, 1 << bits pixels wide; they start at its first pixel.
uvec2 tilesOf(RasterJob job, ivec4 box, out int bits) {
  uint most = min(RASTER_TILES_PER_PIECE, 0xFFFFFFFFu / job.pieces);
  bits = RASTER_TILE_BITS - int(job.kind);
  uvec2 tiles;
  do {
    tiles = uvec2((box.zw - box.xy) >> bits) + 1u;
  } while (tiles.x * tiles.y > most && ++bits < 31);
  return tiles;
}

RasterPieces piecesOf(RasterJob job) {
  return RasterPieces(uint64_t(job.queue) + RASTER_COUNTS_BYTES + job.kind * rasterPartBytes(job.pieces));
}
RasterRests restsOf(RasterJob job) {
  return RasterRests(uint64_t(piecesOf(job)) + RASTER_PIECE_BYTES * uint64_t(job.pieces));
}

/// False: there is no place left. One atomic per counter and subgroup, since atomics queue up at the counter.
bool setAside(RasterJob job, RasterPiece p, uint tiles) {
  uvec4 here = subgroupBallot(true);
  uint place;
  if (subgroupElect()) place = atomicAdd(job.queue.at[job.kind].pieces, subgroupBallotBitCount(here));
  place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(here);
  if (place >= job.pieces) return false;
  piecesOf(job).at[place] = p;
  if (tiles == 1u) return true;
  uvec4 more = subgroupBallot(true);
  uint before = subgroupExclusiveAdd(tiles - 1u), sum = subgroupAdd(tiles - 1u);
  uvec2 start;
  if (subgroupElect())
    start = unpack32(atomicAdd(job.queue.at[job.kind].rests, pack64(uvec2(sum, subgroupBallotBitCount(more)))));
  start = subgroupBroadcastFirst(start);
  RasterRests rests = restsOf(job);
  rests.at[start.y + subgroupBallotExclusiveBitCount(more)] = RasterRest(place, start.x + before);
  return true;
}

/// First pass: a small piece is drawn, another set aside, or drawn all the same where there is no place left for it.
void drawPiece(RasterJob job, RasterPiece p) {
  ivec4 box = bounds(p, job.size);
  if (any(greaterThan(box.xy, box.zw))) return;
  ivec2 extent = box.zw - box.xy + 1;
  if (max(extent.x, extent.y) > RASTER_SMALL || extent.x * extent.y > RASTER_SMALL) {
    int bits;
    uvec2 tiles = tilesOf(job, box, bits);
    if (setAside(job, p, tiles.x * tiles.y)) return;
  }
  rasterBegin(p.triangle);
  scan(p, box, ivec2(0), ivec2(1));
}

void drawTriangle(RasterJob job, uint triangle) {
  vec4 c[3];
  bool cull;
  RasterPiece p;
  if (!rasterCorners(triangle, c, cull) || outOfPicture(c[0], c[1], c[2])) return;
  if (needsNoClip(c[0]) && needsNoClip(c[1]) && needsNoClip(c[2])) {
    if (setUp(triangle, c[0], c[1], c[2], cull, job.size, p)) drawPiece(job, p);
    return;
  }
  // Sutherland and Hodgman 1974; each plane adds a corner at most.
  vec4 polygon[3 + CLIP_PLANES];
  vec4 clipped[3 + CLIP_PLANES];
  int corners = 3;
  for (int i = 0; i < 3; ++i) polygon[i] = c[i];
  for (int plane = 0; plane < CLIP_PLANES; ++plane) {
    int kept = 0;
    for (int i = 0; i < corners; ++i) {
      vec4 from = polygon[i], to = polygon[i + 1 < corners ? i + 1 : 0];
      float f = clipDistance(from, plane), t = clipDistance(to, plane);
      if (f >= 0.0) clipped[kept++] = from;
      // Measured from the inner corner, so that two triangles get the same point on their common edge.
      if ((f >= 0.0) != (t >= 0.0)) clipped[kept++] = f >= 0.0 ? mix(from, to, f / (f - t)) : mix(to, from, t / (t - f));
    }
    corners = kept;
    for (int i = 0; i < corners; ++i) polygon[i] = clipped[i];
  }
  for (int i = 2; i < corners; ++i)
    if (setUp(triangle, polygon[0], polygon[i - 1], polygon[i], cull, job.size, p)) drawPiece(job, p);
}

/// Second pass: a tile of a piece, by its lanes.
void drawTile(RasterJob job, RasterPiece p, uint tile, uint lane) {
  if (p.triangle < job.first || p.triangle >= job.end) return;
  ivec4 box = bounds(p, job.size);
  int bits;
  uvec2 tiles = tilesOf(job, box, bits);
  box.xy += ivec2(tile % tiles.x, tile / tiles.x) << bits;
  box.zw = min(box.zw, box.xy + (1 << bits) - 1);
  rasterBegin(p.triangle);
  scan(p, box, ivec2(lane & 7u, lane >> 3), ivec2(8, RASTER_LANES / 8u));
}

/// The piece that tile `tile`, counted over all tiles but the pieces' first ones, belongs to: the last piece that
/// starts at or before it.
RasterRest restAt(RasterRests rests, uint count, uint tile) {
  uint found = 0u;
  while (count - found > 1u) {
    uint middle = (found + count) / 2u;
    if (rests.at[middle].firstTile <= tile) found = middle;
    else count = middle;
  }
  return rests.at[found];
}

void main() {
  RasterJob job = rasterJob();
  uint index = irad_index();
  if (!TILES) {
    if (index < job.end - job.first) drawTriangle(job, job.first + index);
    return;
  }
  RasterPieces queued = piecesOf(job);
  RasterRests rests = restsOf(job);
  uvec2 rest = unpack32(job.queue.at[job.kind].rests);
  uint pieces = min(job.queue.at[job.kind].pieces, job.pieces);
  uint together = RASTER_WORKGROUP / RASTER_LANES * gl_NumWorkGroups.x;
  for (uint i = index / RASTER_LANES; i < pieces + rest.x; i += together) {
    if (i < pieces) {
      drawTile(job, queued.at[i], 0u, index % RASTER_LANES);
    } else {
      RasterRest r = restAt(rests, rest.y, i - pieces);
      drawTile(job, queued.at[r.piece], 1u + i - pieces - r.firstTile, index % RASTER_LANES);
    }
  }
}
