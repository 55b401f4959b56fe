#include "gi/check/path_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irad::truth {

using glm::dvec3;
using std::numbers::pi;

glm::dmat3 frameAbout(const dvec3& normal) {
  const dvec3 aside = std::abs(normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 t = glm::normalize(glm::cross(normal, aside));
  return {t, glm::cross(normal, t), normal};
}

double ggxDensity(double sine2, double alpha) {
  const double a2 = alpha * alpha, d = sine2 + (1 - sine2) * a2;
  return a2 / (pi * d * d);
}

double smithLambda(double cosine, double alpha) {
  const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  return 0.5 * (std::sqrt(1 + alpha * alpha * std::max(tangent2, 0.0)) - 1);
}

Lobe::Lobe(const dvec3& f0, double roughness, const dvec3& normal, const dvec3& towardsViewer, double weight)
    : there_(true), f0_(f0), alpha_(roughness * roughness), weight_(weight), frame_(frameAbout(normal)) {
  view_ = towardsViewer * frame_;  // its coordinates along the three
  view_.z = std::max(view_.z, kLeastCosine);
  view_ = glm::normalize(view_);
}

dvec3 Lobe::fresnel(double cosine) const {
  const double x = std::clamp(1 - cosine, 0.0, 1.0);
  return weight_ * (f0_ + (1.0 - f0_) * (x * x * x * x * x));
}

dvec3 Lobe::value(const dvec3& towards, double alpha) const {
  const dvec3 l = towards * frame_;
  if (!(l.z > 0)) return dvec3(0);
  const dvec3 h = glm::normalize(l + view_);
  const double masked = 1 / (1 + smithLambda(view_.z, alpha) + smithLambda(l.z, alpha));  // G2
  return fresnel(glm::dot(view_, h)) * (ggxDensity(h.x * h.x + h.y * h.y, alpha) * masked / (4 * l.z * view_.z));
}

dvec3 Lobe::value(const dvec3& towards) const {
  return mirror() ? dvec3(0) : value(towards, alpha_);
}

dvec3 Lobe::valueOfPoint(const dvec3& towards) const {
  return value(towards, std::max(alpha_, kLeastAlpha));
}

dvec3 Lobe::draw(Random& random) const {
  if (mirror()) return frame_ * dvec3(-view_.x, -view_.y, view_.z);
  // Stretched until the microfacets are a hemisphere, whose visible normals are halfway to an even cap of directions.
  const dvec3 v = glm::normalize(dvec3(alpha_ * view_.x, alpha_ * view_.y, view_.z));
  const double phi = 2 * pi * random.next(), z = (1 - random.next()) * (1 + v.z) - v.z,
               r = std::sqrt(std::max(0.0, 1 - z * z));
  const dvec3 half = v + dvec3(r * std::cos(phi), r * std::sin(phi), z);
  const dvec3 h = glm::normalize(dvec3(alpha_ * half.x, alpha_ * half.y, std::max(half.z, 1e-12)));
  return frame_ * (2 * glm::dot(view_, h) * h - view_);
}

double Lobe::density(const dvec3& towards) const {
  if (mirror()) return 0;
  const dvec3 l = towards * frame_, sum = l + view_;
  const double length = glm::length(sum);
  if (!(length > 0) || !(sum.z > 0)) return 0;
  const dvec3 h = sum / length;
  return ggxDensity(h.x * h.x + h.y * h.y, alpha_) / ((1 + smithLambda(view_.z, alpha_)) * 4 * view_.z);
}

}  // namespace irad::truth
