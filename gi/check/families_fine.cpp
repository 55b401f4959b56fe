// What is finer than a voxel: two shells a fraction of one apart, half-filled voxels, a lamp just below a ceiling.
#include <algorithm>
#include <cmath>

#include "gi/check/families.h"

namespace irad {

FamilyMember doubleShell(uint64_t seed, double voxel) {
  Mason mason(seed, 5, voxel);
  const glm::dvec3 hi(mason.between(1.5, 2.5), mason.between(2.2, 3), mason.between(1.5, 3)), lo(-hi.x, 0, -hi.z);
  const double inner = mason.thickness(0.2, 1), gap = mason.thickness(0.2, 2), outer = mason.thickness(0.2, 1);
  const uint32_t floor = mason.paint(), walls = mason.paint(), skin = mason.paint(), lamp = mason.paint(1);
  mason.shell(floor, walls, lo, hi, inner);
  // The inner shell's walls and floor reach 1.7 thicknesses out.
  const double off = 1.7 * inner + gap;
  const glm::dvec3 outerLo = lo - glm::dvec3(off, inner + gap, off), outerHi = hi + glm::dvec3(off, inner + gap, off);
  const double wide = mason.between(0.3, 0.7) * hi.x, middle = mason.between(-0.2, 0.2) * hi.x;
  const Opening window{middle - wide, middle + wide, 0.2 * hi.y, 0.8 * hi.y};
  const Opening door{-0.5 * hi.z, 0.4 * hi.z, 0.3 * hi.y, 0.9 * hi.y};
  mason.shell(skin, skin, outerLo, outerHi, outer, {door, std::nullopt, std::nullopt, window});
  // Cameras are above lamps, whose backs they see through.
  // A lamp of 1 W/m^2 inside, a sun of 1000 outside.
  const double x = mason.between(-0.3, 0.3) * hi.x, y = hi.y - mason.between(0.4, 0.7), half = 0.35;
  mason.lamp(lamp, x, y, half, half);
  mason.builder.sun({mason.between(0.4, 1), -mason.between(0.4, 0.8), -1}, 1000);
  mason.builder.camera({-0.8 * hi.x, hi.y - 0.15, -0.85 * hi.z}, {0.4 * hi.x, 0.35 * hi.y, hi.z});
  mason.builder.camera({0.8 * hi.x, hi.y - 0.2, 0.8 * hi.z}, {-0.5 * hi.x, 0.1 * hi.y, -0.5 * hi.z});
  FamilyMember member;
  member.scene = mason.finish("double-shell", member.sealed);
  return member;
}

FamilyMember halfFilled(uint64_t seed, double voxel) {
  Mason mason(seed, 6, voxel);
  const glm::dvec3 hi(mason.between(1.8, 2.6), mason.between(2.3, 3), mason.between(1.8, 2.8)), lo(-hi.x, 0, -hi.z);
  const double t = mason.thickness(0.5, 2);
  const uint32_t floor = mason.paint(), walls = mason.paint(), wood = mason.paint(), stone = mason.paint(),
                 lamp = mason.paint(100), cloth = mason.paint();
  const Opening window{-0.5 * hi.x, 0.3 * hi.x, 0.3 * hi.y, 0.85 * hi.y};
  mason.shell(floor, walls, lo, hi, t, {std::nullopt, std::nullopt, std::nullopt, window});
  // Blinds before the window: slats that lean, the sun behind them.
  const double pitch = voxel * mason.between(0.8, 1.6), slat = voxel * mason.between(0.6, 1), thin = 0.12 * voxel,
               lean = mason.between(0.3, 1);
  const glm::dvec3 across(0, 0.5 * slat * std::sin(lean), 0.5 * slat * std::cos(lean));
  const double blind = hi.z - 0.6 * slat - 0.02;
  const int slats = std::max(1, static_cast<int>((window.high - window.low) / pitch));
  for (int k = 0; k < slats; ++k) {
    const glm::dvec3 at(0, window.low + (k + 0.5) * pitch, blind);
    mason.board(cloth, at - across, at + across, {1, 0, 0}, window.to - window.from, thin);
  }
  // Boards along the wall at -x, each half a voxel thick, on a side board.
  const double deep = mason.between(0.3, 0.5), thick = voxel * mason.between(0.35, 0.65),
               apart = voxel * mason.between(1.1, 1.9);
  const int boards = std::clamp(static_cast<int>(1.8 / apart), 1, 20);
  for (int k = 0; k < boards; ++k) {
    const double y = 0.15 + apart * k;
    mason.block(wood, {lo.x - 0.3 * t, y, -0.7 * hi.z}, {lo.x + deep, y + thick, 0.5 * hi.z});
  }
  mason.block(wood, {lo.x - 0.3 * t, -0.3 * t, 0.5 * hi.z - 0.5 * thick},
              {lo.x + deep + 0.02, 0.2 + apart * boards, 0.5 * hi.z + 0.5 * thick});
  // Cubes on the floor, and a step half a voxel high.
  const double edge = voxel * mason.between(0.4, 0.7), stride = voxel * mason.between(1.2, 2);
  const int across0 = std::clamp(static_cast<int>(1.2 * hi.x / stride), 1, 10);
  for (int i = 0; i < across0; ++i)
    for (int j = 0; j < across0; ++j) {
      const glm::dvec3 at(-0.1 * hi.x + stride * i, 0, -0.8 * hi.z + stride * j);
      mason.block(stone, at - glm::dvec3(0, 0.2 * t, 0), at + glm::dvec3(edge));
    }
  mason.block(stone, {-0.3 * hi.x, -0.2 * t, 0.45 * hi.z}, {0.9 * hi.x, 0.5 * voxel, 0.75 * hi.z});
  const double y = hi.y - 0.5, half = 0.3;
  mason.lamp(lamp, 0, y, half, half);
  mason.builder.sun({mason.between(-0.3, 0.3), -mason.between(0.3, 0.7), -1}, 100);
  mason.builder.camera({0.85 * hi.x, hi.y - 0.2, 0.3 * hi.z}, {lo.x, 0.25 * hi.y, -0.3 * hi.z});
  mason.builder.camera({0.2 * hi.x, hi.y - 0.25, -0.92 * hi.z}, {0, 0.3 * hi.y, hi.z});
  FamilyMember member;
  member.scene = mason.finish("half-filled", member.sealed);
  return member;
}

FamilyMember lampAtCeiling(uint64_t seed, double voxel) {
  Mason mason(seed, 7, voxel);
  const glm::dvec3 hi(mason.between(1.5, 2.5), mason.between(2.2, 3), mason.between(1.5, 3)), lo(-hi.x, 0, -hi.z);
  // All four combinations among any four seeds in a row.
  const bool twoSided = seed % 2 != 0, reversed = seed / 2 % 2 != 0;
  const uint32_t floor = mason.paint(), walls = mason.paint(), lamp = mason.paint(100, twoSided), box = mason.paint();
  mason.shell(floor, walls, lo, hi, mason.thickness(0.5, 3));
  const double below = mason.thickness(0.1, 0.8), y = hi.y - below, x = mason.between(-0.3, 0.3) * hi.x;
  const double wide = mason.between(0.3, 0.6), deep = mason.between(0.3, 0.8);
  mason.lamp(lamp, x, y, wide, deep);
  const double high = mason.between(0.4, 1);
  mason.block(box, {0.2 * hi.x, -0.01, -0.6 * hi.z}, {0.7 * hi.x, high, -0.1 * hi.z});
  mason.builder.camera({-0.85 * hi.x, 0.8 * hi.y, 0.85 * hi.z}, {0.4 * hi.x, 0.1 * hi.y, -0.5 * hi.z});
  // Straight up at the ceiling beside the lamp.
  const double low = 0.25 * hi.y, seen = 0.55 * (hi.y - low), side = x > 0 ? -1 : 1;
  const double beside = std::clamp(x + side * (wide + 1.15 * seen), -0.9 * hi.x, 0.9 * hi.x);
  mason.builder.camera({beside, low, 0}, {beside, hi.y, 0});
  FamilyMember member;
  member.scene = mason.finish("near-lamp", member.sealed);
  if (reversed) reverseTriangles(member.scene);
  return member;
}

}  // namespace irad
