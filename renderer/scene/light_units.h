// A light's strength in other units than its file's, and the colours of black bodies. The engine is radiometric and
// takes glTF's photometric lights one to one (docs/conventions.md): 1 cd is 1 W/sr, 1 lx is 1 W/m^2, and so 1 lm is 1
// W.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace irad {

struct Light;

/// The solid angle (sr) that intensity times equals all of a light's power: 4 pi of a point, of a spot that of its cone
/// with the falloff between inner and outer angle weighed in. 0 of a cone that is closed, and of a distant light, which
/// has no power of its own.
double solidAngle(const Light& light);

/// The temperatures (K) that colours are known for: Krystek's approximation holds from 1,000 to 15,000.
constexpr double kLeastTemperature = 1000, kMostTemperature = 15000;

/// Chromaticity on the Planckian locus, CIE 1960 u and v, of a temperature (K, clamped to those above). M. Krystek, "An
/// algorithm to calculate correlated colour temperature", Color Research & Application 10 (1985): u and v are
/// within 1e-4 of the CIE 1931 observer's.
glm::dvec2 planckianUv(double kelvin);

/// The linear colour (sRGB's primaries and white, D65) of a black body, its largest component 1. Below about 1,900 K
/// the locus lies outside of sRGB's gamut: what would be negative is 0.
glm::vec3 temperatureColor(double kelvin);

/// The correlated colour temperature (K) of a linear colour: that of the nearest point of the locus in CIE 1960 u, v.
/// None of black, and of colours further from the locus than 0.05, for which CIE (15:2004) does not define one.
std::optional<double> colorTemperature(const glm::vec3& color);

}  // namespace irad
