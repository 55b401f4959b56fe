// Something small in much larger surroundings: what scene.region is for.
#include <cmath>

#include "gi/check/families.h"

namespace irad {
namespace {

/// Boxes that stand about the middle of y = 0, run into each other and are as large as a car.
void heap(Mason& mason, double floor) {
  const int parts = mason.whole(2, 4);
  for (int i = 0; i < parts; ++i) {
    const double x = mason.between(-1.2, 1.2), z = mason.between(-1.2, 1.2), wide = mason.between(0.4, 1.2),
                 deep = mason.between(0.4, 1.2), high = mason.between(0.5, 1.8);
    mason.block(mason.paint(), {x - 0.5 * wide, floor, z - 0.5 * deep}, {x + 0.5 * wide, floor + high, z + 0.5 * deep});
  }
}

void camerasAround(Mason& mason) {
  for (int i = 0; i < 2; ++i) {
    const double angle = mason.between(0, 6.28), away = mason.between(3, 4);
    mason.builder.camera({away * std::cos(angle), mason.between(1, 2.5), away * std::sin(angle)}, {0, 0.6, 0});
  }
}

void plane(Mason& mason, double half) {
  const auto h = static_cast<float>(half);
  mason.builder.quad(mason.paint(), {-h, 0, h}, {h, 0, h}, {h, 0, -h}, {-h, 0, -h});
}

}  // namespace

FamilyMember objectOnPlane(uint64_t seed, double voxel) {
  Mason mason(seed, 8, voxel);
  plane(mason, mason.between(60, 120));
  heap(mason, 0);
  mason.builder.sun(glm::vec3(mason.between(-1, 1), mason.between(-1.5, -0.6), mason.between(-1, 1)), 3);
  camerasAround(mason);
  FamilyMember member;
  member.scene = mason.finish("object on a plane", member.sealed);
  return member;
}

FamilyMember underDome(uint64_t seed, double voxel) {
  Mason mason(seed, 9, voxel);
  // Black, as a picture of a sky is: what lies outside passes no light on.
  const uint32_t dome = mason.paint(mason.between(2, 4));
  mason.builder.edit(dome).baseColor = glm::vec4(0, 0, 0, 1);
  mason.builder.sphere(dome, glm::vec3(0), static_cast<float>(mason.between(70, 130)), /*inward=*/true, /*rings=*/16);
  // A deck, so that what stands on it has something below.
  mason.block(mason.paint(), {-1.6, -0.3, -1.6}, {1.6, 0, 1.6});
  heap(mason, -0.1);
  camerasAround(mason);
  FamilyMember member;
  member.scene = mason.finish("object under a dome", member.sealed);
  return member;
}

FamilyMember roomInDesert(uint64_t seed, double voxel) {
  Mason mason(seed, 10, voxel);
  plane(mason, mason.between(70, 120));
  const glm::dvec3 lo(-mason.between(1.2, 1.6), 0.1, -mason.between(1.2, 1.6)),
      hi(mason.between(1.2, 1.6), mason.between(2, 2.4), mason.between(1.2, 1.6));
  const double middle = mason.between(-0.3, 0.3), wide = mason.between(0.7, 1);
  const Opening door{middle - 0.5 * wide, middle + 0.5 * wide, 0.1, mason.between(1.6, 1.8)};
  mason.shell(mason.paint(), mason.paint(), lo, hi, 0.2, {std::nullopt, std::nullopt, std::nullopt, door});
  mason.builder.sun(glm::vec3(mason.between(-0.3, 0.3), mason.between(-0.9, -0.5), -1), 3);
  mason.builder.camera({0.8 * lo.x, 1.5, 0.8 * lo.z}, {0.3 * hi.x, 0.7, 0.6 * hi.z});
  mason.builder.camera({0.8 * hi.x, 1.2, 0.5 * lo.z}, {middle, 0.8, hi.z});
  FamilyMember member;
  member.scene = mason.finish("room in a desert", member.sealed);
  return member;
}

}  // namespace irad
