// The groups of the catalogue, one file each.
#pragma once

#include <vector>

#include "gi/check/check.h"

namespace irad {

std::vector<CheckCase> furnaceCases();     ///< closed rooms whose answer is known everywhere
std::vector<CheckCase> skyCases();         ///< open to a sky
std::vector<CheckCase> formFactorCases();  ///< rows of the matrix against Howell's catalogue
std::vector<CheckCase> energyCases();      ///< conservation, reciprocity, linearity
std::vector<CheckCase> limitCases();       ///< dark, black, white and worse albedos
std::vector<CheckCase> rangeCases();       ///< emission, scale, rotation, position
std::vector<CheckCase> inputCases();       ///< degenerate and damaged geometry
std::vector<CheckCase> leakCases();
std::vector<CheckCase> roomCases();       ///< families of rooms by seed, against 0 and a path tracer
std::vector<CheckCase> glassCases();      ///< blended surfaces, against a path tracer
std::vector<CheckCase> samplingCases();   ///< encodings, sampler, traversals
std::vector<CheckCase> writebackCases();  ///< reflections as a source
std::vector<CheckCase> stabilityCases();  ///< the same bits over time, under toggling, in other memory and processes
std::vector<CheckCase> guardCases();      ///< capacities, memory, divergence

}  // namespace irad
