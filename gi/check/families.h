// Families of hard scenes: sizes, tilt, wall thickness, colours and light come from a seed; truth is 0 or the path
// tracer (path_tracer.h). What is thin or small is so in voxels of the grid that the scene is judged at, .2 to 3 of
// them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gi/check/mason.h"
#include "renderer/scene/scene.h"

namespace irad {

/// A member of a family.
struct FamilyMember {
  Scene scene;               ///< cameras are inside, sun outside
  std::vector<Room> sealed;  ///< where no light gets; only in families whose truth is 0
};

struct Family {
  const char* name;  ///< as in `irad check`
  const char* setup;
  /// Builds the member of this seed with voxels of this edge, m. Pure.
  FamilyMember (*build)(uint64_t seed, double voxel);
  bool dark = false;     ///< truth is 0 inside
  bool outside = false;  ///< most of it is far around: scene.region = auto is held against whole
};

std::span<const Family> families();
/// The member for a grid of `resolution` voxels along the longest axis. Pure.
FamilyMember familyMember(const Family& family, uint64_t seed, uint32_t resolution);

// One per family; docs/stability.md describes them.
FamilyMember sealedBuilding(uint64_t seed, double voxel);
FamilyMember twoRooms(uint64_t seed, double voxel);
FamilyMember bentTunnel(uint64_t seed, double voxel);
FamilyMember doorAjar(uint64_t seed, double voxel);
FamilyMember doubleShell(uint64_t seed, double voxel);
FamilyMember halfFilled(uint64_t seed, double voxel);
FamilyMember lampAtCeiling(uint64_t seed, double voxel);
FamilyMember objectOnPlane(uint64_t seed, double voxel);
FamilyMember underDome(uint64_t seed, double voxel);
FamilyMember roomInDesert(uint64_t seed, double voxel);

}  // namespace irad
