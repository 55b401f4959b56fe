// The angle between two directions.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace irad {

/// In degrees, between any two vectors that are not 0; exact for small angles too.
inline double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
}

}  // namespace irad
