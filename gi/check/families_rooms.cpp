// Light around corners: rooms and doors, tunnels, a door that is ajar.
#include <cmath>

#include "gi/check/families.h"

namespace irad {
namespace {

/// Two rooms side by side along x, the wall between them with a door: `first` is x < 0, `second` x > 0.
struct TwoRooms {
  glm::dvec3 lo, hi;  ///< of both together
  double wall, floor;
  double split;  ///< thickness of the wall between them, which begins at x = 0
  Opening door;  ///< along z
};

TwoRooms drawTwoRooms(Mason& mason) {
  const double first = mason.between(3, 4.5), second = mason.between(2.5, 4), depth = mason.between(3, 4.5);
  TwoRooms t{.lo = {-first, 0, -0.5 * depth},
             .hi = {second, mason.between(2.4, 3), 0.5 * depth},
             .wall = mason.thickness(),
             .floor = 0,
             .split = mason.thickness(),
             .door = {}};
  t.hi.x += t.split;
  const double wide = mason.between(0.8, 1.2), at = mason.between(-0.25, 0.25) * (depth - wide);
  t.door = {at - 0.5 * wide, at + 0.5 * wide, 0, mason.between(0.75, 0.85) * t.hi.y};
  return t;
}

/// The wall with the door, into the walls around it.
void splitWall(Mason& mason, const TwoRooms& t, uint32_t paint) {
  const double into = 0.5 * t.wall;
  Opening door = t.door;
  door.low = t.lo.y - into;
  mason.wall(paint, 0, 0, t.split, t.lo.z - into, t.hi.z + into, t.lo.y - into, t.hi.y + into, door);
}

/// One in each room; both look at the door.
void camerasAtDoor(Mason& mason, const TwoRooms& t) {
  const glm::dvec3 door(0.5 * t.split, 0.45 * t.hi.y, 0.5 * (t.door.from + t.door.to));
  const double aside = door.z > 0 ? -1 : 1;
  mason.builder.camera({0.9 * t.lo.x, 0.6 * t.hi.y, aside * 0.4 * t.hi.z}, door);
  mason.builder.camera({t.split + 0.92 * (t.hi.x - t.split), 0.55 * t.hi.y, aside * 0.7 * t.hi.z}, door);
}

}  // namespace

FamilyMember twoRooms(uint64_t seed, double voxel) {
  Mason mason(seed, 2, voxel);
  const TwoRooms t = drawTwoRooms(mason);
  // The outer door is in the wall at +z of the first room; the sun comes in through it.
  const double wide = mason.between(1, 1.6), middle = mason.between(0.4, 0.6) * t.lo.x;
  const Opening outer{middle - 0.5 * wide, middle + 0.5 * wide, 0, mason.between(0.75, 0.85) * t.hi.y};
  const uint32_t floor = mason.paint(), walls = mason.paint(), between = mason.paint();
  mason.shell(floor, walls, t.lo, t.hi, t.wall, {std::nullopt, std::nullopt, std::nullopt, outer});
  splitWall(mason, t, between);
  // A doorstep, which the sun lights, too.
  mason.block(floor, {outer.from - 0.5, -t.wall - 0.05, t.hi.z + 0.5 * t.wall},
              {outer.to + 0.5, -0.02, t.hi.z + 1.7 * t.wall + 0.8});
  mason.builder.sun({mason.between(-0.4, 0.4), -mason.between(0.35, 0.8), -1}, 100);
  camerasAtDoor(mason, t);
  FamilyMember member;
  member.scene = mason.finish("two-rooms", member.sealed);
  return member;
}

FamilyMember doorAjar(uint64_t seed, double voxel) {
  Mason mason(seed, 4, voxel);
  const TwoRooms t = drawTwoRooms(mason);
  const uint32_t floor = mason.paint(), walls = mason.paint(), between = mason.paint(), wood = mason.paint();
  mason.shell(floor, walls, t.lo, t.hi, t.wall);
  splitWall(mason, t, between);
  // The leaf hangs in the opening at the side of the first room, opens into it, and leaves a gap of 8 mm all around.
  const double gap = 0.008, leaf = std::min(mason.thickness(0.2, 1), 0.12), angle = mason.between(0.08, 0.5);
  const glm::dvec3 hinge(0.2 * leaf, 0, t.door.from + gap);
  const glm::dvec3 along(-std::sin(angle), 0, std::cos(angle));
  const double length = t.door.to - t.door.from - 2 * gap, high = t.door.high - 2 * gap;
  const glm::dvec3 middle = hinge + glm::dvec3(0.5 * leaf, gap + 0.5 * high, 0);
  mason.board(wood, middle, middle + along * length, {0, 1, 0}, high, leaf);
  // The lamp hangs in the first room.
  const double x = mason.between(0.4, 0.65) * t.lo.x, y = t.hi.y - mason.between(0.3, 0.5), half = 0.25;
  const uint32_t lamp = mason.paint(/*exitance=*/200);
  mason.lamp(lamp, x, y, half, half);
  camerasAtDoor(mason, t);
  FamilyMember member;
  member.scene = mason.finish("door-ajar", member.sealed);
  return member;
}

FamilyMember bentTunnel(uint64_t seed, double voxel) {
  // From the mouth at z = 0 towards -z, then towards +x, then (some) towards -z again.
  Mason mason(seed, 3, voxel);
  const double wide = mason.between(1.6, 2.4), high = mason.between(2, 2.6), t = mason.thickness();
  const double first = mason.between(3, 4.5) + wide, second = mason.between(2, 3.5) + wide;
  const bool twice = mason.chance(0.5);
  const double third = twice ? mason.between(1.5, 2.5) : 0;
  const uint32_t floor = mason.paint(), ceiling = mason.paint(), left = mason.paint(), right = mason.paint();
  const double back = -first - third, into = 0.5 * t, past = 0.6 * t;
  mason.block(floor, {-1.7 * t, -t, back - 1.7 * t}, {second + 1.7 * t, 0, 0.8});
  mason.block(ceiling, {-1.4 * t, high, back - 1.4 * t}, {second + 1.4 * t, high + t, 0.05});
  const auto wall = [&](uint32_t paint, int axis, double at, double from, double to) {
    mason.wall(paint, axis, at, t, from - past, to + past, -into, high + into);
  };
  wall(left, 0, -t, -first, 0);                      // outer side of the first part
  wall(right, 0, wide, -first + wide + 1.1 * t, 0);  // inner side
  wall(right, 2, -first + wide, wide, second);       // the second part, towards the mouth
  if (twice) {
    wall(left, 2, -first - t, -t, second - wide);  // the second part's far side, up to the third
    wall(left, 0, second - wide - t, back, -first - 1.1 * t);
    wall(right, 0, second, back, -first + wide);
    wall(left, 2, back - t, second - wide - t, second);
  } else {
    wall(left, 2, -first - t, -t, second);
    wall(right, 0, second, -first, -first + wide);
  }
  mason.builder.sun({mason.between(-0.15, 0.35), -mason.between(0.3, 0.6), -1}, 100);
  mason.builder.camera({0.3 * wide, 0.6 * high, -0.35 * first}, {0.6 * wide, 0.4 * high, -first});
  mason.builder.camera({second - 0.15 * wide, 0.6 * high, -first + 0.3 * wide}, {0, 0.4 * high, -first + 0.5 * wide});
  if (twice)
    mason.builder.camera({second - 0.3 * wide, 0.6 * high, back + 0.1},
                         {second - 0.5 * wide, 0.4 * high, -first + wide});
  FamilyMember member;
  member.scene = mason.finish("bent-tunnel", member.sealed);
  return member;
}

}  // namespace irad
