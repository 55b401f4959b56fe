// Small scenes whose light is known in closed form (docs/stability.md), built in code: for `irad check` and the test
// suites.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

/// A scene put together from quads and spheres; the result is what loadScene would give.
class SceneBuilder {
 public:
  /// A Lambertian material: diffuse albedo and exitance M (W/m^2, = pi x emitted radiance). Returns its index.
  uint32_t material(glm::vec3 albedo, glm::vec3 exitance = glm::vec3(0.0f), bool doubleSided = false);
  /// Corners counter-clockwise seen from the front, cut into n x n squares of two triangles.
  void quad(uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, uint32_t n = 1);
  /// Six walls; `inward`: seen from inside. `materials`: -x +x -y +y -z +z. Points are turned by `rotation` about 0.
  void box(const std::vector<uint32_t>& materials, glm::vec3 lo, glm::vec3 hi, bool inward,
           const glm::mat3& rotation = glm::mat3(1.0f));
  /// Latitude-longitude sphere with `rings` rings from +y to -y.
  void sphere(uint32_t material, glm::vec3 centre, float radius, bool inward, uint32_t rings = 64);
  /// Rings `first` to `last` - 1 of that sphere.
  void zone(uint32_t material, glm::vec3 centre, float radius, bool inward, uint32_t rings, uint32_t first,
            uint32_t last);
  void sun(glm::vec3 direction, float lux);
  void point(glm::dvec3 position, float candela);
  /// What finish() would put at the centre of the bounds, looking along -z, otherwise.
  void camera(glm::dvec3 position, glm::dvec3 target);
  Material& edit(uint32_t material) { return scene_.materials.at(material); }
  /// Groups the triangles by material, sets bounds and a camera. The builder is empty afterwards.
  Scene finish(std::string name);

 private:
  void triangle(uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c);
  Scene scene_;
  std::vector<std::vector<glm::vec3>> corners_;  ///< three per triangle, per material
};

/// The same scene with its triangles in opposite order.
void reverseTriangles(Scene& scene);

/// Closed unit box, every wall albedo rho and exitance M = 1: B = 1 / (1 - rho) everywhere.
Scene furnaceBox(float rho);
/// The same turned by 31 degrees about (1, 2, 3).
Scene furnaceTilted(float rho);
/// Closed sphere of radius 1.
Scene furnaceSphere(float rho);
/// furnaceTilted of edge 1 around a second one of edge .4, turned the other way, that faces outwards.
Scene furnaceInner(float rho);
/// Closed sphere of radius 1, rho = .8, whose upper cap of a quarter of the area emits M = 1.
Scene sphereCap();
/// Closed unit cube, rho 0, one material per wall (-x +x -y +y -z +z), so that walls can be told apart.
Scene unitCube(float rho = 0.0f);
/// Two unit squares facing each other across `distance`: floor (material 0, emits 1) and ceiling (material 1).
Scene parallelSquares(float distance);
/// Two square plates of side 1, `gap` apart, facing each other: albedos .9 and .3, the first emits M = 1.
Scene plates(float gap, float rho0 = 0.9f, float rho1 = 0.3f);
/// A room with a tilted box, a ball and a thin two-sided shelf: every kind of edge.
Scene furnishedRoom();
/// A room of 2 x 2 x 2 whose ceiling is a lamp, with a ball in it, to be finished.
SceneBuilder lampRoom();
/// lampRoom() with a metal ball, a point light and a sun: something for every stage.
Scene mixedRoom();
/// A room of 2 x 1.25 x 1.25, open towards +z, seen from there: coloured walls, a lamp, a point light, a turned box and
/// a glossy ball, to be finished. Exitance and intensity are multiplied by `light`.
SceneBuilder stillLife(float light = 1.0f);
/// stillLife() as it is.
Scene stillScene();

/// H where no light comes from anywhere; of a plane, too, which sees nothing of itself.
glm::dvec3 noLight(const glm::dvec3& position, const glm::dvec3& normal);
/// Form factor from a point of a surface to a polygon in front of it (Lambert 1760).
double formFactorPolygon(const glm::dvec3& position, const glm::dvec3& normal,
                         const std::array<glm::dvec3, 4>& corners);
/// Form factor between two parallel, aligned, unit squares at distance d (Howell's catalogue, C-11).
double formFactorParallelSquares(double d);
/// Form factor between two perpendicular unit squares with a common edge (C-14).
double formFactorPerpendicularSquares();
/// Mean B of plates(gap, rho0, rho1), W/m^2: the double integral over 32 x 32 patches of each.
std::pair<double, double> plateRadiosity(double gap, double rho0, double rho1);

}  // namespace irad
