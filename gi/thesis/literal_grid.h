// The grid of T eq. 4-7 to the letter (thesis.literal): no padding, floored dimensions, p == max outside.
#pragma once

#include "shaders/shared/grid.h"

namespace irad {

Grid makeLiteralGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t resolution);

}  // namespace irad
