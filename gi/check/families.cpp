#include "gi/check/families.h"

#include <algorithm>
#include <array>

namespace irad {

std::span<const Family> families() {
  static const std::array all{
      Family{"sealed", "a building in the sun: vaults, gables, columns through slabs, buttresses, opaque panes",
             sealedBuilding, /*dark=*/true},
      Family{"two-rooms", "two rooms and a door, the sun through the outer one", twoRooms},
      Family{"bent-tunnel", "a tunnel with one bend or two, the sun at its mouth", bentTunnel},
      Family{"door-ajar", "a lamp behind a door that is ajar", doorAjar},
      Family{"double-shell", "a dim lamp in a shell within a shell that the sun shines into", doubleShell},
      Family{"half-filled", "boards, cubes and blinds whose faces fill half a voxel", halfFilled},
      Family{"near-lamp", "a lamp nearer to the ceiling than a voxel: one-sided, two-sided, both orders",
             lampAtCeiling},
      Family{"object-on-plane", "boxes as large as a car on a plane of 120 to 240 m, in the sun", objectOnPlane,
             /*dark=*/false, /*outside=*/true},
      Family{"under-dome", "the same on a deck in the middle of an emissive sphere of 140 to 260 m", underDome,
             /*dark=*/false, /*outside=*/true},
      Family{"room-in-desert", "a room with a door on such a plane, the sun at the door", roomInDesert,
             /*dark=*/false, /*outside=*/true},
  };
  return all;
}

FamilyMember familyMember(const Family& family, uint64_t seed, uint32_t resolution) {
  // How large a voxel is depends on how thick the outer parts are, which depends on the voxel: the third time it has
  // settled.
  FamilyMember member;
  double voxel = 12.0 / resolution;
  for (int pass = 0; pass < 4; ++pass) {
    member = family.build(seed, voxel);
    const glm::vec3 extent = member.scene.boundsMax - member.scene.boundsMin;
    voxel = double{std::max({extent.x, extent.y, extent.z})} / (resolution - 1.0 / 128);
  }
  return member;
}

}  // namespace irad
