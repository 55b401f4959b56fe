// FLIP: how different two pictures look to a person who flips between them (Andersson, Nilsson, Akenine-Moeller,
// Oskarsson, Astroem and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images", HPG).
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace irad {

/// Of a screen 0.7 m away that shows 3840 pixels on 0.7 m, as the paper has it.
inline constexpr double kFlipPixelsPerDegree = 67.02064;

/// LDR-FLIP of every pixel, 0 to 1, top row first. The pictures hold linear light of Rec. 709 primaries, clamped to
/// [0, 1] here.
std::vector<double> flipErrors(glm::uvec2 size, std::span<const glm::vec4> picture,
                               std::span<const glm::vec4> reference, double pixelsPerDegree = kFlipPixelsPerDegree);
/// Their mean.
double flip(glm::uvec2 size, std::span<const glm::vec4> picture, std::span<const glm::vec4> reference,
            double pixelsPerDegree = kFlipPixelsPerDegree);

/// Two colours' distance after the spatial filter: HyAB (Abasi, Amani Tehran and Fairchild 2020) of Hunt-adjusted
/// L*a*b*.
double huntHyab(const glm::dvec3& linear, const glm::dvec3& other);

}  // namespace irad
