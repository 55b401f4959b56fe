// Weights of a triangle's corners at a point of the picture.
#ifndef IRAD_RASTER_CORNER_WEIGHTS_GLSL
#define IRAD_RASTER_CORNER_WEIGHTS_GLSL

/// Perspective-correct, sum 1: clip-space corners relative to the point are as areas (Olano and Greer 1997, "Triangle
/// Scan Conversion Using 2D Homogeneous Coordinates"), so that nothing is divided by a w that may be 0 or below. For a
/// triangle seen edge-on, the first corner.
vec3 cornerWeights(vec4 c[3], vec2 ndc) {
  vec2 p[3];
  for (int i = 0; i < 3; ++i) p[i] = c[i].xy - ndc * c[i].w;
  vec3 w = vec3(p[1].x * p[2].y - p[1].y * p[2].x, p[2].x * p[0].y - p[2].y * p[0].x, p[0].x * p[1].y - p[0].y * p[1].x);
  float sum = w.x + w.y + w.z;
  return sum != 0.0 ? w / sum : vec3(1.0, 0.0, 0.0);
}

/// A pixel's centre in the clip space of the whole picture, y up.
vec2 pixelCentre(ivec2 pixel, uvec2 size) {
  return (vec2(pixel) + 0.5) / vec2(size) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
}

/// Weights of a point that belongs to the triangle up to rounding and the snapping of corners, which slivers would
/// otherwise extrapolate from.
vec3 weightsWithin(vec3 w) {
  w = max(w, 0.0);
  return w / (w.x + w.y + w.z);
}

/// At the pixel's centre, and at three of the four pixels whose differences the graphics pipeline takes for derivatives.
struct PixelWeights {
  vec3 here;
  vec3 first, right, below;  ///< of the 2 x 2 pixels
};
PixelWeights pixelWeights(vec4 c[3], ivec2 pixel, uvec2 size) {
  ivec2 quad = pixel & ~1;
  return PixelWeights(weightsWithin(cornerWeights(c, pixelCentre(pixel, size))),
                      cornerWeights(c, pixelCentre(quad, size)),
                      cornerWeights(c, pixelCentre(quad + ivec2(1, 0), size)),
                      cornerWeights(c, pixelCentre(quad + ivec2(0, 1), size)));
}

// By differences: exact where the three are equal.
vec4 weighted(vec4 a, vec4 b, vec4 c, vec3 weights) { return a + (b - a) * weights.y + (c - a) * weights.z; }
vec3 weighted(vec3 a, vec3 b, vec3 c, vec3 weights) { return a + (b - a) * weights.y + (c - a) * weights.z; }

#endif
