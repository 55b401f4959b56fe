// The same picture whatever the light's strength, the scene's size, its axes and its place; and a lamp that few rays
// meet.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "gi/check/cases.h"
#include "gi/check/glb.h"
#include "gi/check/pictures.h"
#include "gi/check/scenes.h"
#include "gi/grid.h"
#include "gi/lighting.h"
#include "shaders/shared/surface.h"

namespace irad {
namespace {

constexpr glm::uvec2 kRangePicture(96);

CheckPicture lit(CheckRun& run, Scene scene, const Settings& settings) {
  const auto pipeline = run.prepare(std::move(scene), settings);
  return run.picture(*pipeline, pipeline->scene().cameras[0], VIEW_LIT, kRangePicture);
}
CheckPicture lit(CheckRun& run, Scene scene) {
  return lit(run, std::move(scene), run.settings);
}

void emissionRangeCase(CheckRun& run) {
  const CheckPicture one = lit(run, stillScene());
  for (const float e : {1e-6f, 1e6f}) {
    const PictureError error = compare(lit(run, stillLife(e).finish("still life")), one, e);
    run.atMost(fmt::format("E = {:g}: largest |image / E - image| / mean", e), error.largest, 1e-3);
  }
}

constexpr float kTinyExitance = 1e4f;  ///< W/m^2

/// A lamp of nearly one voxel's face (a hundredth smaller, so that it touches no other voxel), in a cube of edge 2 of
/// 64 voxels: it fills a ten-thousandth of what the floor sees.
std::array<glm::dvec3, 4> tinyLamp(uint32_t resolution) {
  const Grid grid = makeGrid(glm::vec3(-1), glm::vec3(1), resolution);
  const double x = grid.dims.x / 2, z = grid.dims.z / 2, y = std::floor(0.875 * resolution) + 1.5;
  const auto corner = [&](double dx, double dz) {
    return glm::dvec3(grid.origin) + double{grid.edge} * glm::dvec3(x + dx, y, z + dz);
  };
  constexpr double kLow = 0.005, kHigh = 0.995;
  return {corner(kLow, kLow), corner(kHigh, kLow), corner(kHigh, kHigh), corner(kLow, kHigh)};
}

/// The closed cube, rho = 0, with that lamp, which faces down.
Scene tinyEmitter(uint32_t resolution) {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.0f)), lamp = b.material(glm::vec3(0.0f), glm::vec3(kTinyExitance));
  b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  const std::array<glm::dvec3, 4> face = tinyLamp(resolution);
  b.quad(lamp, face[0], face[1], face[2], face[3]);
  b.camera({0, 0, 0.95}, {0, -0.5, -1});
  return b.finish("tiny-emitter");
}

/// RMS and mean of H on the floor over the closed form, less 1.
std::pair<double, double> floorError(CheckRun& run, const Pipeline& pipeline) {
  const std::array<glm::dvec3, 4> lamp = tinyLamp(run.settings.voxel.resolution);
  const HostFacets facets = run.facets(pipeline);
  const std::vector<glm::vec3> h = run.read(pipeline, pipeline.lighting().indirect);
  double squares = 0, sum = 0, n = 0;
  for (size_t i = 0; i < h.size(); ++i) {
    if (facets.normal[i].y < 0.99 || facets.position[i].y > -0.9) continue;
    const double expected = kTinyExitance * formFactorPolygon(facets.position[i], facets.normal[i], lamp);
    const double error = h[i].x / expected - 1;
    squares += error * error;
    sum += error;
    ++n;
  }
  return {std::sqrt(squares / n), sum / n};
}

void tinyEmitterCase(CheckRun& run) {
  const auto pipeline = run.prepare(tinyEmitter(run.settings.voxel.resolution));
  const auto [noise, bias] = floorError(run, *pipeline);
  run.atMost("RMS of H / (F M) - 1 on the floor", noise, 0.05);
  run.near("mean of H / (F M) on the floor", 1 + bias, 1, 0.002);
  Settings rays = run.settings;
  rays.matrix.emitterSampling = EffectMode::off;
  pipeline->set(rays);
  pipeline->prepare();
  run.info("RMS without emitter sampling", floorError(run, *pipeline).first);
}

Scene tinyEmitterScene() {
  return tinyEmitter(64);
}
/// rho = 0: H is the lamp's light alone, which shines down.
glm::dvec3 tinyEmitterLight(const glm::dvec3& position, const glm::dvec3& normal) {
  const std::array<glm::dvec3, 4> lamp = tinyLamp(64);
  if (position.y >= lamp[0].y || glm::dot(normal, lamp[0] - position) <= 0) return glm::dvec3(0);
  return glm::dvec3(kTinyExitance * formFactorPolygon(position, normal, lamp));
}

void scale2Case(CheckRun& run) {
  const CheckPicture one = lit(run, stillScene());
  for (const int power : {-10, 13})
    run.none(fmt::format("pixels that differ at 2^{}", power),
             countDiffering(lit(run, scaled(stillScene(), std::ldexp(1.0f, power))), one));
}

/// What one of a small facet's rays, and of those are the fewest, can bring a pixel at most, W/(m^2 sr): the largest
/// rho (B - M) / pi over their number. (M comes by emitter sampling.)
double lightOfRay(CheckRun& run, const Pipeline& pipeline) {
  const HostFacets facets = run.facets(pipeline);
  const std::vector<glm::vec3> b = run.read(pipeline, pipeline.lighting().radiosity);
  float albedo = 0, largest = 0;
  for (size_t i = 0; i < b.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      albedo = std::max(albedo, facets.albedo[i][c]);
      largest = std::max(largest, b[i][c] - facets.emission[i][c]);
    }
  return double{albedo} * double{largest} / std::numbers::pi / LEAST_RAYS;
}

void scale10Case(CheckRun& run) {
  // A ray that passes an edge more closely than fp32 can tell may fall to the other side. How far H is blurred goes by
  // the noise that the rays tell of, so that there such a ray counts for itself and in what is kept: by V at most
  // twice, by sigma^2 at most c^1/2 < 1 times as much (docs/method.md 7).
  const std::pair<SampleFilter, double> filters[] = {{SampleFilter::linear, 1}, {SampleFilter::blur, 1 + 2 + 1}};
  for (const auto& [filter, rays] : filters) {
    Settings settings = run.settings;
    settings.sample.gpu.filter_ = filter;
    const auto pipeline = run.prepare(stillScene(), settings);
    const CheckPicture one = run.picture(*pipeline, pipeline->scene().cameras[0], VIEW_LIT, kRangePicture);
    const double ray = lightOfRay(run, *pipeline) / meanOf(one);
    for (const float s : {1e-3f, 0.07f, 30.0f, 1e4f}) {
      const PictureError error = compare(lit(run, scaled(stillScene(), s), settings), one);
      const std::string name = fmt::format("{}, x {:g}", nameOf(filter), s);
      run.atMost(name + ": mean |difference| / mean", error.mean, 1e-4);
      run.atMost(name + ": largest difference / mean", error.largest, rays * ray);
    }
  }
}

void rotate90Case(CheckRun& run) {
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  // Pixels draw rays of their lobes by where they lie in the picture, and the mirrored picture has them elsewhere: with
  // few rays that noise would be most of what differs.
  Settings settings = run.settings;
  settings.specular.gpu.rays = 64;
  const CheckPicture upright = lit(run, stillScene(), settings);
  const auto judge = [&](const char* name, const CheckPicture& picture) {
    const PictureError error = compare(picture, upright);
    run.atMost(fmt::format("{}: mean |difference| / mean", name), error.mean, 0.01);
    run.info(fmt::format("{}: difference of the means", name), error.brightness);
  };
  judge("about x", lit(run, permuted(stillScene(), glm::mat3(x, z, -y)), settings));
  judge("about y", lit(run, permuted(stillScene(), glm::mat3(-z, y, x)), settings));
  judge("about z", lit(run, permuted(stillScene(), glm::mat3(y, -x, z)), settings));
  judge("mirror", flipped(lit(run, permuted(stillScene(), glm::mat3(-x, y, z)), settings)));
}

/// Ten units wide; coordinates are multiples of 2^-16, which double precision still holds at 10^6.
Scene tenUnits() {
  Scene scene = scaled(stillScene(), 5);
  for (glm::vec3& p : scene.positions) p = glm::round(p * 65536.0f) / 65536.0f;
  return scene;
}

void farAwayCase(CheckRun& run) {
  const auto load = [](const glm::dvec3& offset) { return throughLoader(tenUnits(), offset); };
  const CheckPicture centred = lit(run, load({0, 0, 0}));
  const Scene far = load({1e6, -1e6, 1e6});
  run.none("warnings", far.warnings.size());
  const CheckPicture picture = lit(run, far);
  run.none("pixels that differ", countDiffering(picture, centred));
  run.near("largest difference / mean", compare(picture, centred).largest, 0, 0);  // NaN, were both black
}

}  // namespace

std::vector<CheckCase> rangeCases() {
  return {
      {"emission-range", "a still life, its lights times 1e-6 ... 1e6", "image / E constant", "1e-3 of the mean",
       emissionRangeCase, stillScene},
      {"tiny-emitter", "one voxel shines in a black room, F = 1e-4", "F M by Lambert's formula",
       "noise <= 5 % with emitter sampling", tinyEmitterCase, tinyEmitterScene, tinyEmitterLight},
      {"scale-2", "a still life x 2^-10, x 2^13", "the same picture", "bits equal", scale2Case, stillScene},
      {"scale-10", "a still life x 1e-3 ... 1e4", "the same picture", "mean 1e-4, a pixel 1 ray of 32 (blurred 4)",
       scale10Case, stillScene},
      {"rotate-90", "a still life turned by 90 degrees about each axis, and mirrored", "the mapped picture", "mean 1 %",
       rotate90Case, stillScene},
      {"far-away", "a still life ten units wide, loaded at 1e6", "the picture of the centred one", "equal", farAwayCase,
       tenUnits},
  };
}

}  // namespace irad
