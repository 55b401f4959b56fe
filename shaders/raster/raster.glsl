// Rasterization by a compute kernel, by the graphics pipeline's rules: corners snapped to 1/256 pixel, exact edge
// functions (Pineda 1988, "A Parallel Algorithm for Polygon Rasterization"), shared edges drawn once (top-left rule),
// depth affine in the picture, clip space with y up. A first pass gives each triangle an invocation, which draws small
// ones and sets the others aside; in a second one workgroups share those, tile by tile (as Laine and Karras 2011,
// "High-Performance Software Rasterization on GPUs", and Nanite part small from large).
#include "shared/raster.h"

layout(local_size_x = 64) in;
layout(constant_id = RASTER_TILES) const bool TILES = false;

struct RasterJob {
  RasterQueue queue;
  uvec2 size;       ///< pixels
  uint first, end;  ///< triangles
};

// From the including shader.
RasterJob rasterJob();
/// Corners in clip space, and whether triangles that show their back (clockwise) are left out. False: nothing to draw.
/// What it keeps in globals is there for rasterPixel of the same triangle.
bool rasterCorners(uint triangle, out vec4 corners[3], out bool cull);
void rasterPixel(uint triangle, ivec2 pixel, float depth);

/// Corners further than this many half-pictures off the axis are clipped, so that edge functions fit 64 bits.
const float GUARD = 8.0;
const int CLIP_PLANES = 6;

/// >= 0 inside.
float clipDistance(vec4 c, int plane) {
  switch (plane) {
    case 0: return c.z;
    case 1: return c.w - c.z;
    case 2: return GUARD * c.w - c.x;
    case 3: return GUARD * c.w + c.x;
    case 4: return GUARD * c.w - c.y;
    default: return GUARD * c.w + c.y;
  }
}

bool needsNoClip(vec4 c) {
  return c.z >= 0.0 && c.z <= c.w && max(abs(c.x), abs(c.y)) <= GUARD * c.w;
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

/// Pixels whose centres the snapped bounds hold: first xy, last zw.
ivec4 pixelsBetween(ivec2 lo, ivec2 hi, uvec2 size) {
  return ivec4(max((lo + 127) >> 8, ivec2(0)), min((hi - 128) >> 8, ivec2(size) - 1));
}

/// Twice the area of p, q, r, positive if they turn clockwise to the eye.
int64_t turn(ivec2 p, ivec2 q, ivec2 r) {
  return int64_t(q.x - p.x) * int64_t(r.y - p.y) - int64_t(q.y - p.y) * int64_t(r.x - p.x);
}

/// Least value of the edge function p, q of a pixel that belongs to the triangle: one on a top or left edge does.
int64_t leastInside(ivec2 p, ivec2 q) {
  return q.y < p.y || (q.y == p.y && q.x > p.x) ? int64_t(0) : int64_t(1);
}

/// The pixels of a triangle, or of a piece of a clipped one, within `box`: every one, or those of this invocation of the
/// workgroup.
void scanPiece(uint triangle, vec4 ca, vec4 cb, vec4 cc, bool cull, ivec4 box, uvec2 size) {
  ivec2 a = snapped(ca, size), b = snapped(cb, size), c = snapped(cc, size);
  precise float da = ca.z / ca.w;
  precise float db = cb.z / cb.w;
  precise float dc = cc.z / cc.w;
  int64_t area = turn(a, b, c);
  if (area == 0 || (cull && area > 0)) return;
  if (area < 0) {
    ivec2 p = b;
    b = c;
    c = p;
    float d = db;
    db = dc;
    dc = d;
    area = -area;
  }
  ivec4 own = pixelsBetween(min(a, min(b, c)), max(a, max(b, c)), size);
  box = ivec4(max(box.xy, own.xy), min(box.zw, own.zw));
  int stride = 1;
  if (TILES) {
    stride = 8;
    box.xy += ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
  }
  if (any(greaterThan(box.xy, box.zw))) return;
  ivec2 at = box.xy * 256 + 128;
  int64_t rowA = turn(b, c, at), rowB = turn(c, a, at), rowC = turn(a, b, at);
  int64_t step = int64_t(256 * stride);
  int64_t leastA = leastInside(b, c), leastB = leastInside(c, a), leastC = leastInside(a, b);
  precise float inverseArea = 1.0 / float(area);
  for (int y = box.y; y <= box.w; y += stride) {
    int64_t ea = rowA, eb = rowB, ec = rowC;
    for (int x = box.x; x <= box.z; x += stride) {
      if (ea >= leastA && eb >= leastB && ec >= leastC) {
        precise float toB = float(eb) * inverseArea;
        precise float toC = float(ec) * inverseArea;
        precise float depth = da + (toB * (db - da) + toC * (dc - da));
        rasterPixel(triangle, ivec2(x, y), clamp(depth, 0.0, 1.0));
      }
      ea -= int64_t(c.y - b.y) * step;
      eb -= int64_t(a.y - c.y) * step;
      ec -= int64_t(b.y - a.y) * step;
    }
    rowA += int64_t(c.x - b.x) * step;
    rowB += int64_t(a.x - c.x) * step;
    rowC += int64_t(b.x - a.x) * step;
  }
}

/// Level and number of the tiles that a box is cut into; they start at its first pixel.
uvec2 tilesOf(ivec4 box, out int bits) {
  bits = RASTER_TILE_BITS;
  uvec2 tiles;
  do {
    tiles = uvec2((box.zw - box.xy) >> bits) + 1u;
  } while (tiles.x * tiles.y > RASTER_TILES_PER_TRIANGLE && ++bits < 31);
  return tiles;
}

/// What of `box` is to be drawn here and now: in the first pass all of a small one, none of another, which is set aside;
/// in the second the tile.
bool claim(RasterJob job, uint triangle, uint tile, inout ivec4 box) {
  if (any(greaterThan(box.xy, box.zw))) return false;
  ivec2 extent = box.zw - box.xy + 1;
  if (!TILES && extent.x <= RASTER_SMALL && extent.y <= RASTER_SMALL && extent.x * extent.y <= RASTER_SMALL) return true;
  int bits;
  uvec2 tiles = tilesOf(box, bits);
  if (TILES) {
    box.xy += ivec2(tile % tiles.x, tile / tiles.x) << bits;
    box.zw = min(box.zw, box.xy + (1 << bits) - 1);
    return true;
  }
  RasterCounter counter = RasterCounter(job.queue);
  uvec2 before = unpack32(atomicAdd(counter.at[0], pack64(uvec2(tiles.x * tiles.y, 1u))));
  job.queue.at[1u + before.y] = uvec2(triangle, before.x);
  return false;
}

void rasterize(RasterJob job, uint triangle, uint tile) {
  vec4 c[3];
  bool cull;
  if (!rasterCorners(triangle, c, cull) || outOfPicture(c[0], c[1], c[2])) return;
  if (needsNoClip(c[0]) && needsNoClip(c[1]) && needsNoClip(c[2])) {
    ivec2 a = snapped(c[0], job.size), b = snapped(c[1], job.size), d = snapped(c[2], job.size);
    ivec4 box = pixelsBetween(min(a, min(b, d)), max(a, max(b, d)), job.size);
    if (claim(job, triangle, tile, box)) scanPiece(triangle, c[0], c[1], c[2], cull, box, job.size);
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
      if ((f >= 0.0) != (t >= 0.0)) {
        // From the inner corner, so that two triangles get the same point of the edge between them.
        vec4 point = f >= 0.0 ? mix(from, to, f / (f - t)) : mix(to, from, t / (t - f));
        clipped[kept++] = point;
      }
    }
    corners = kept;
    for (int i = 0; i < corners; ++i) polygon[i] = clipped[i];
  }
  if (corners < 3) return;
  ivec2 lo = ivec2(0x7FFFFFFF), hi = ivec2(-0x7FFFFFFF);
  for (int i = 0; i < corners; ++i) {
    ivec2 at = snapped(polygon[i], job.size);
    lo = min(lo, at);
    hi = max(hi, at);
  }
  ivec4 box = pixelsBetween(lo, hi, job.size);
  if (!claim(job, triangle, tile, box)) return;
  for (int i = 2; i < corners; ++i)
    scanPiece(triangle, polygon[0], polygon[i - 1], polygon[i], cull, box, job.size);
}

void main() {
  RasterJob job = rasterJob();
  if (!TILES) {
    uint triangle = job.first + irad_index();
    if (triangle < job.end) rasterize(job, triangle, 0u);
    return;
  }
  uvec2 total = job.queue.at[0];
  for (uint tile = gl_WorkGroupID.x; tile < total.x; tile += gl_NumWorkGroups.x) {
    // The last triangle that starts at or before this tile.
    uint found = 0u, end = total.y;
    while (end - found > 1u) {
      uint middle = (found + end) / 2u;
      if (job.queue.at[1u + middle].y <= tile) found = middle;
      else end = middle;
    }
    uvec2 item = job.queue.at[1u + found];
    if (item.x >= job.first && item.x < job.end) rasterize(job, item.x, tile - item.y);
  }
}
