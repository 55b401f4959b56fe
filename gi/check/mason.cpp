#include "gi/check/mason.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "renderer/base/error.h"

namespace irad {

bool Room::contains(const glm::dvec3& p) const {
  return std::ranges::all_of(planes, [&](const glm::dvec4& plane) { return glm::dot(glm::dvec3(plane), p) < plane.w; });
}

Room Room::between(const glm::dvec3& lo, const glm::dvec3& hi) {
  return {{{1, 0, 0, hi.x}, {-1, 0, 0, -lo.x}, {0, 1, 0, hi.y}, {0, -1, 0, -lo.y}, {0, 0, 1, hi.z}, {0, 0, -1, -lo.z}}};
}

double Mason::thickness(double lo, double hi) {
  return voxel * lo * std::pow(hi / lo, random_.next());
}

uint32_t Mason::paint(double exitance, bool doubleSided) {
  glm::vec3 albedo;
  for (int c = 0; c < 3; ++c) albedo[c] = static_cast<float>(between(0.3, 0.8));
  return builder.material(albedo, glm::vec3(static_cast<float>(exitance)), doubleSided);
}

void Mason::block(uint32_t material, const glm::dvec3& lo, const glm::dvec3& hi) {
  builder.box(std::vector<uint32_t>(6, material), lo, hi, /*inward=*/false);
}

void Mason::board(uint32_t material, const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& across,
                  double wide, double thick) {
  const glm::dvec3 along = glm::normalize(to - from), up = glm::cross(across, along);
  const glm::dvec3 middle = 0.5 * (from + to);
  const glm::dvec3 half(0.5 * glm::length(to - from), 0.5 * thick, 0.5 * wide);
  const glm::dmat3 axes(along, -up, glm::cross(along, -up));
  const auto corner = [&](int x, int y, int z) { return glm::vec3(middle + axes * (half * glm::dvec3(x, y, z))); };
  const auto face = [&](std::array<glm::ivec3, 4> c) {
    builder.quad(material, corner(c[0].x, c[0].y, c[0].z), corner(c[1].x, c[1].y, c[1].z),
                 corner(c[2].x, c[2].y, c[2].z), corner(c[3].x, c[3].y, c[3].z));
  };
  // (along, -up, along x -up) is right-handed: counter-clockwise seen from outside.
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      std::array<glm::ivec3, 4> c;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int k = 0; k < 4; ++k) {
        c[k][axis] = side;
        c[k][u] = k == 1 || k == 2 ? 1 : -1;
        c[k][v] = k >= 2 ? 1 : -1;
      }
      if (side < 0) std::swap(c[1], c[3]);
      face(c);
    }
}

void Mason::lamp(uint32_t material, double x, double y, double wide, double deep) {
  builder.quad(material, {x - wide, y, -deep}, {x + wide, y, -deep}, {x + wide, y, deep}, {x - wide, y, deep});
}

void Mason::column(uint32_t material, double x, double z, double radius, double low, double high, int sides) {
  const auto at = [&](int k, double y) {
    const double phi = 2 * std::numbers::pi * (k + 0.5) / sides;
    return glm::vec3(x + radius * std::cos(phi), y, z - radius * std::sin(phi));
  };
  const glm::vec3 bottom(x, low, z), top(x, high, z);
  IRAD_CHECK(sides >= 4 && sides % 2 == 0, "{} sides", sides);
  for (int k = 0; k < sides; ++k) {
    builder.quad(material, at(k, low), at(k + 1, low), at(k + 1, high), at(k, high));
    if (k % 2 != 0) continue;
    builder.quad(material, top, at(k, high), at(k + 1, high), at(k + 2, high));
    builder.quad(material, bottom, at(k + 2, low), at(k + 1, low), at(k, low));
  }
}

namespace {
/// Corners of a block in a wall across `axis`.
std::pair<glm::dvec3, glm::dvec3> inWall(int axis, double at, double thick, const Opening& o) {
  return axis == 0 ? std::pair{glm::dvec3(at, o.low, o.from), glm::dvec3(at + thick, o.high, o.to)}
                   : std::pair{glm::dvec3(o.from, o.low, at), glm::dvec3(o.to, o.high, at + thick)};
}
}  // namespace

void Mason::wall(uint32_t material, int axis, double at, double thick, double from, double to, double low, double high,
                 const std::optional<Opening>& opening) {
  const auto part = [&](double inset, const Opening& o) {
    const auto [lo, hi] = inWall(axis, at + inset, thick - 2 * inset, o);
    block(material, lo, hi);
  };
  if (!opening) return part(0, {from, to, low, high});
  const Opening& o = *opening;
  const bool sill = o.low > low;
  const double over = 0.3 * (high - o.high), under = sill ? 0.3 * (o.low - low) : 0, inset = 0.05 * thick;
  if (sill) part(0, {from, to, low, o.low});
  part(0, {from, to, o.high, high});
  part(inset, {from, o.from, o.low - under, o.high + over});
  part(inset, {o.to, to, o.low - under, o.high + over});
}

void Mason::pane(uint32_t material, int axis, double at, double thick, const Opening& o, double paneThick) {
  const double more = std::max(0.05, 0.5 * thick);
  const auto [lo, hi] = inWall(axis, at + 0.5 * (thick - paneThick), paneThick,
                               {o.from - more, o.to + more, o.low - more, o.high + more});
  block(material, lo, hi);
}

void Mason::shell(uint32_t floor, uint32_t walls, const glm::dvec3& lo, const glm::dvec3& hi, double thick,
                  const std::array<std::optional<Opening>, 4>& openings) {
  const double t = thick, into = 0.5 * t, past = 1.7 * t;
  block(floor, {lo.x - past, lo.y - t, lo.z - past}, {hi.x + past, lo.y, hi.z + past});
  block(walls, {lo.x - 1.3 * t, hi.y, lo.z - 1.3 * t}, {hi.x + 1.3 * t, hi.y + t, hi.z + 1.3 * t});
  // Walls across x end within those across z. A door's opening begins at the floor.
  const auto opened = [&](std::optional<Opening> o) {
    if (o && o->low <= lo.y) o->low = lo.y - into;
    return o;
  };
  wall(walls, 0, lo.x - t, t, lo.z - into, hi.z + into, lo.y - into, hi.y + into, opened(openings[0]));
  wall(walls, 0, hi.x, t, lo.z - into, hi.z + into, lo.y - into, hi.y + into, opened(openings[1]));
  wall(walls, 2, lo.z - t, t, lo.x - 1.2 * t, hi.x + 1.2 * t, lo.y - into, hi.y + into, opened(openings[2]));
  wall(walls, 2, hi.z, t, lo.x - 1.2 * t, hi.x + 1.2 * t, lo.y - into, hi.y + into, opened(openings[3]));
}

Scene Mason::finish(std::string name, std::vector<Room>& rooms) {
  const int how = whole(0, 2);
  const double angle = between(0.1, 1.4);
  glm::dvec3 axis(0, 1, 0);
  for (int c = 0; c < 3; ++c) {
    const double drawn = between(-1, 1);
    if (how == 2) axis[c] = drawn;
  }
  const glm::dmat3 turn =
      how == 0 ? glm::dmat3(1) : glm::dmat3(glm::rotate(glm::dmat4(1), angle, glm::normalize(axis)));
  const glm::mat3 turnVertices(turn);

  Scene scene = builder.finish(std::move(name));
  scene.boundsMin = glm::vec3(std::numeric_limits<float>::max());
  scene.boundsMax = -scene.boundsMin;
  for (glm::vec3& p : scene.positions) {
    p = turnVertices * p;
    scene.boundsMin = glm::min(scene.boundsMin, p);
    scene.boundsMax = glm::max(scene.boundsMax, p);
  }
  for (glm::vec3& n : scene.normals) n = glm::normalize(turnVertices * n);
  for (glm::vec4& t : scene.tangents) t = glm::vec4(glm::normalize(turnVertices * glm::vec3(t)), t.w);
  for (Light& light : scene.lights) {
    light.position = turn * light.position;
    light.direction = glm::normalize(turnVertices * light.direction);
  }
  for (Camera& camera : scene.cameras) {
    camera.position = turn * camera.position;
    camera.orientation = glm::normalize(glm::quat_cast(turnVertices * glm::mat3_cast(camera.orientation)));
    camera.znear = 0.01f;
  }
  for (Room& room : rooms)
    for (glm::dvec4& plane : room.planes) plane = glm::dvec4(turn * glm::dvec3(plane), plane.w);
  for (Material& material : scene.materials) material.lambertian = true;
  return scene;
}

}  // namespace irad
