// The structs of shaders/shared as C++ lays them out. Generated (tests/shared_structs.cmake).
#pragma once

#include <string>
#include <vector>

#include "renderer/shaders.h"

namespace irad::test {

std::vector<std::string> sharedHeaders();  ///< "shared/solve.h"
std::vector<ReflectedStruct> sharedStructs();

}  // namespace irad::test
