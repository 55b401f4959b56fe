// The specular lobe: GGX microfacets, Smith's height-correlated masking-shadowing, Schlick's Fresnel (glTF 2.0,
// appendix B), and its visible normals (Heitz 2018). Vectors are unit; `alpha` is roughness squared.
#ifndef IRAD_SHARED_GGX_H
#define IRAD_SHARED_GGX_H
#include "shared/types.h"
IRAD_BEGIN

/// Lobes narrower than this are drawn as this wide for point-like lights, whose mirror image has no size.
IRAD_CONST float GGX_LEAST_ALPHA = 2e-3f;

/// `sin2`: the squared sine between normal and half vector. The cosine is so near 1 within a narrow lobe that too few
/// digits are left: at alpha = .002 the last of them is worth 6 % of the peak.
IRAD_FN float ggxDistribution(float sin2, float alpha) {
  float a2 = alpha * alpha;
  float d = sin2 + (1.0f - sin2) * a2;
  return a2 / (IRAD_PI * d * d);
}
/// G2 / (4 n.l n.v), height-correlated (Heitz 2014, eq. 99).
IRAD_FN float ggxVisibility(float nl, float nv, float alpha) {
  float a2 = alpha * alpha;
  float l = nv * sqrt(nl * nl * (1.0f - a2) + a2);
  float v = nl * sqrt(nv * nv * (1.0f - a2) + a2);
  return 0.5f / (l + v);
}
/// Smith's Lambda: G1 = 1 / (1 + Lambda).
IRAD_FN float ggxLambda(float cosine, float alpha) {
  float c2 = cosine * cosine;
  return 0.5f * (sqrt(1.0f + alpha * alpha * (1.0f - c2) / c2) - 1.0f);
}
IRAD_FN vec3 fresnelSchlick(vec3 f0, float vh) {
  float x = 1.0f - vh;
  float x2 = x * x;
  float x5 = x2 * x2 * x;
  return f0 + (vec3(1.0f) - f0) * x5;
}

/// A visible normal about +Z for the view vector `v` (v.z > 0); Heitz, "Sampling the GGX Distribution of Visible
/// Normals", JCGT 7(4), 2018. A ray reflected about it carries the weight F G2 / G1.
IRAD_FN vec3 ggxVisibleNormal(vec3 v, float alpha, vec2 u) {
  vec3 vh = normalize(vec3(alpha * v.x, alpha * v.y, v.z));
  float lensq = vh.x * vh.x + vh.y * vh.y;
  float len = sqrt(lensq);
  vec3 t1 = len > 0.0f ? vec3(-vh.y / len, vh.x / len, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
  vec3 t2 = cross(vh, t1);
  float r = sqrt(u.x);
  float phi = 2.0f * IRAD_PI * u.y;
  float p1 = r * cos(phi);
  float p2 = r * sin(phi);
  float s = 0.5f * (1.0f + vh.z);
  p2 = (1.0f - s) * sqrt(1.0f - p1 * p1) + s * p2;
  float p3sq = 1.0f - p1 * p1 - p2 * p2;
  float p3 = sqrt(p3sq > 0.0f ? p3sq : 0.0f);
  vec3 nh = t1 * p1 + t2 * p2 + vh * p3;
  return normalize(vec3(alpha * nh.x, alpha * nh.y, nh.z > 1e-6f ? nh.z : 1e-6f));
}

/// G2 / G1 of a reflected ray: what is left of the weight besides F.
IRAD_FN float ggxWeight(float nl, float nv, float alpha) {
  float lv = ggxLambda(nv, alpha);
  return (1.0f + lv) / (1.0f + lv + ggxLambda(nl, alpha));
}

/// Directional albedo of the lobe under white light: f0 x (all - edge) + edge, where `edge` is Schlick's part. Both are
/// least-squares polynomials, made for this lobe, that are exact for a mirror; within .036 where n.v > .1.
IRAD_FN vec3 environmentBrdf(vec3 f0, float roughness, float nv) {
  float r = roughness;
  float c = nv;
  float a0 = -5.8332f + r * (22.1316f + r * (-27.9624f + r * 11.5777f));
  float a1 = 28.0291f + r * (-128.9920f + r * (176.0114f - r * 76.7464f));
  float a2 = -37.9632f + r * (192.0086f + r * (-279.2693f + r * 127.1622f));
  float a3 = 15.9243f + r * (-85.3756f + r * (128.4758f - r * 59.8749f));
  float all_ = 1.0f + r * r * (a0 + c * (a1 + c * (a2 + c * a3)));
  float x = 1.0f - nv;
  float x3 = x * x * x;
  float b0 = -31.2631f + r * (131.8638f + r * (-176.8729f + r * 76.4923f));
  float b1 = 112.8397f + r * (-455.1411f + r * (593.4196f - r * 251.7155f));
  float b2 = -95.8076f + r * (359.9579f + r * (-452.3037f + r * 187.5762f));
  float edge = x3 * (x * x + r * r * (b0 + x * (b1 + x * b2)));
  if (all_ > 1.0f) all_ = 1.0f;
  if (edge > all_) edge = all_;
  if (edge < 0.0f) edge = 0.0f;
  return f0 * (all_ - edge) + vec3(edge);
}

IRAD_END
#endif
