// A building that lets no light in. Every part is solid, and from each to the next they run into each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "gi/check/families.h"

namespace irad {
namespace {

struct Building {
  Mason& mason;
  double width, height, depth;  ///< inside; the height is that of the walls
  double wall, floor, roof;     ///< thickness
  double eaves;
  Room room;
  double top = 0;  ///< of the roof
};

void flatRoof(Building& b) {
  const double x = 0.5 * b.width + b.wall + b.eaves, z = 0.5 * b.depth + b.wall + b.eaves;
  b.mason.block(b.mason.paint(), {-x, b.height, -z}, {x, b.height + b.roof, z});
  b.room.planes.emplace_back(0, 1, 0, b.height);
  b.top = b.height + b.roof;
}

/// Two slabs that meet above the ridge, through the gable walls.
void gableRoof(Building& b) {
  const double rise = b.mason.between(0.35, 0.9), run = 0.5 * b.width + 0.5 * b.wall;  // slope; to the walls' middle
  const double ridge = b.height + rise * run, c = 1 / std::sqrt(1 + rise * rise);
  const uint32_t tiles = b.mason.paint();
  const double beyond = 0.3 * b.roof + 0.02;  // past the ridge
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 down(side * c, -rise * c, 0), top(0, ridge, 0);
    const glm::dvec3 eave = top + down * ((run + b.wall + b.eaves) / c);
    b.mason.board(tiles, eave, top - down * beyond, {0, 0, 1}, b.depth + 2 * (b.wall + b.eaves), b.roof);
    // The inside ends at the slab's lower face, whose normal is (side rise c, c, 0).
    b.room.planes.emplace_back(side * rise * c, c, 0, c * ridge - 0.5 * b.roof);
  }
  b.top = ridge + b.roof;
}

/// A barrel vault of strips: chords of an arc that begins and ends in the middle of the walls.
void vaultedRoof(Building& b) {
  const double radius = 0.5 * (b.width + b.wall), rise = b.mason.between(0.5, 1) * radius;
  const int strips = b.mason.whole(6, 14);
  const uint32_t stone = b.mason.paint();
  const auto at = [&](double k) {
    const double phi = std::numbers::pi * k / strips;
    return glm::dvec3(radius * std::cos(phi), b.height + rise * std::sin(phi), 0);
  };
  for (int k = 0; k < strips; ++k) {
    const glm::dvec3 from = at(k), to = at(k + 1), along = glm::normalize(to - from);
    const double more = 0.5 * b.roof;  // into the neighbours, and below the wall's top
    b.mason.board(stone, from - along * (k == 0 ? more + b.wall : more),
                  to + along * (k == strips - 1 ? more + b.wall : more), {0, 0, 1}, b.depth + 1.1 * b.wall, b.roof);
    const glm::dvec3 out(along.y, -along.x, 0);  // away from the axis
    b.room.planes.emplace_back(out, glm::dot(out, from) - 0.5 * b.roof);
  }
  b.top = b.height + rise + b.roof;
}

}  // namespace

FamilyMember sealedBuilding(uint64_t seed, double voxel) {
  Mason mason(seed, 1, voxel);
  Building b{.mason = mason,
             .width = mason.between(3, 6),
             .height = mason.between(2.5, 4),
             .depth = mason.between(4, 8),
             .wall = mason.thickness(),
             .floor = mason.thickness(),
             .roof = mason.thickness(),
             .eaves = mason.between(0.2, 0.6),
             .room = {}};
  const double x = 0.5 * b.width, z = 0.5 * b.depth;
  b.room = Room::between({-x, 0, -z}, {x, 100, z});

  // The ground carries the walls, and is the floor inside; or there is a floor above it that ends within the walls.
  const double margin = mason.between(0.6, 1.5), outside = 0.5 * b.floor;
  const uint32_t earth = mason.paint(), plaster = mason.paint();
  const double ground = mason.chance(0.5) ? 0 : -mason.between(0.1, 0.4);
  mason.block(earth, {-x - margin, ground - b.floor, -z - margin}, {x + margin, ground, z + margin});
  if (ground < 0)
    mason.block(mason.paint(), {-x - 0.5 * b.wall, -b.floor, -z - 0.5 * b.wall},
                {x + 0.5 * b.wall, 0, z + 0.5 * b.wall});

  const int roof = mason.whole(0, 2);
  if (roof == 0) flatRoof(b);
  if (roof == 1) gableRoof(b);
  if (roof == 2) vaultedRoof(b);

  // Side walls end within the roof; end walls rise above it, or end within it where it is flat.
  const double low = ground - outside, sideTop = roof == 0 ? b.height + 0.5 * b.roof : b.height;
  const double endTop = roof == 0 ? sideTop : b.top + 0.2;
  const uint32_t glass = mason.paint();
  const auto window = [&](double half, double sill, double head) {
    const double middle = mason.between(-0.3, 0.3) * half, wide = mason.between(0.15, 0.4) * half;
    return Opening{middle - wide, middle + wide, sill, head};
  };
  const auto built = [&](int axis, double at, double half, double top, double t) {
    const double head = mason.between(0.7, 0.85) * b.height, sill = mason.between(0.2, 0.5) * b.height;
    const Opening o = window(half, sill, head);
    const double paneThick = std::min(mason.thickness(0.2, 0.6), 0.8 * t);
    const bool open = mason.chance(0.7);
    const double past = axis == 0 ? 0.6 * t : 1.7 * t;
    mason.wall(plaster, axis, at, t, -half - past, half + past, low, top, open ? std::optional(o) : std::nullopt);
    if (open) mason.pane(glass, axis, at, t, o, paneThick);
  };
  built(0, -x - b.wall, z, sideTop, b.wall);
  built(0, x, z, sideTop, b.wall);
  built(2, -z - b.wall, x, endTop, b.wall);
  built(2, z, x, endTop, b.wall);

  // Columns from below the floor to above the roof.
  const uint32_t marble = mason.paint();
  const int columns = mason.whole(0, 3);
  const double radius = std::max(mason.between(0.08, 0.25), 0.1 * voxel), aside = mason.between(0.15, 0.3) * b.width;
  const int sides = 2 * mason.whole(2, 4);
  for (int k = 0; k < columns; ++k) {
    const double along = -0.25 * b.depth + 0.5 * b.depth * (k + 0.5) / columns;
    for (const double side : {-aside, aside})
      mason.column(marble, side, along, radius, ground - b.floor - 0.1, b.top + 0.15, sides);
  }

  // Buttresses: some end within the wall, some go through; boards lean on them.
  const int buttresses = mason.whole(0, 3);
  const double deep = mason.between(0.3, 0.8) * std::min(1.0, margin), broad = mason.thickness(0.5, 3);
  for (int k = 0; k < buttresses; ++k) {
    const double along = b.depth * ((k + 0.5) / buttresses - 0.5);
    const double inner = mason.chance(0.5) ? x - mason.between(0.05, 0.2) : x + 0.4 * b.wall;
    const double high = mason.between(0.5, 0.95) * b.height;
    mason.block(marble, {inner, low, along}, {x + b.wall + deep, high, along + broad});
    mason.block(marble, {-x - b.wall - deep, low, along}, {-inner, high, along + broad});
    mason.board(marble, {x + b.wall + 1.2 * deep, ground - 0.5 * b.floor, along + 0.5 * broad},
                {x + 0.5 * b.wall, high, along + 0.5 * broad}, {0, 0, 1}, 0.6 * broad, 0.8 * broad);
  }

  const double azimuth = mason.between(0, 2 * std::numbers::pi), elevation = mason.between(0.35, 1.1);
  mason.builder.sun(
      {std::cos(azimuth) * std::cos(elevation), -std::sin(elevation), std::sin(azimuth) * std::cos(elevation)}, 100);
  mason.builder.camera({-0.36 * b.width, 0.45 * b.height, -0.42 * b.depth},
                       {0.3 * b.width, 0.4 * b.height, 0.5 * b.depth});
  mason.builder.camera({0.36 * b.width, 0.6 * b.height, 0.42 * b.depth},
                       {-0.2 * b.width, 0.9 * b.height, -0.4 * b.depth});
  FamilyMember member{.scene = {}, .sealed = {b.room}};
  member.scene = mason.finish("sealed", member.sealed);
  return member;
}

}  // namespace irad
