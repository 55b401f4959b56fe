// Which subsystem memory belongs to, for the memory table: the method's subsystems.
#pragma once

#include "renderer/resources.h"

namespace irad::Subsystem {

inline constexpr SubsystemName Voxels{"voxels"}, Field{"field"}, Facets{"facets"}, Matrix{"matrix"}, Solver{"solver"},
    Volumes{"volumes"}, Specular{"specular"}, Writeback{"writeback"};

}  // namespace irad::Subsystem
