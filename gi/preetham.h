// The clear sky of Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight" (SIGGRAPH 1999).
#pragma once

#include <glm/glm.hpp>

#include "renderer/scene/sky_image.h"

namespace irad {

/// The zenith's luminance, kcd/m^2; `fromZenith`: of the sun, radians, pi/2 at most.
double preethamZenith(double turbidity, double fromZenith);
/// What its sun brings to a surface that faces it, klx. Lower than 5 degrees it counts as 5 degrees high.
double preethamSun(double turbidity, double fromZenith);
/// The sky, linear, its luminance in kcd/m^2; black below the horizon. A sun that has set counts as setting.
SkyTexels preethamSky(float turbidity, const glm::vec3& towardsSun);
/// What the upper half of a sky brings to a horizontal plane.
glm::dvec3 irradianceFromAbove(const SkyTexels& sky);

}  // namespace irad
