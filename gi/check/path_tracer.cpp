#include "gi/check/path_tracer.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

#include "gi/check/path_sky.h"
#include "gi/check/path_surfaces.h"
#include "gi/embree_scene.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

using truth::kNoTriangle;
using truth::Random;
using truth::SkyLight;
using truth::SurfacePoint;
using truth::Surfaces;

constexpr float kFar = std::numeric_limits<float>::infinity();

/// What a ray passes through: the triangle that it leaves, the one that it goes to, holes of masks, and from some
/// distance on hidden backs, those of single-sided faces.
struct Passing {
  RTCIntersectContext context;  // first: Embree hands back its address
  const Surfaces* surfaces;
  uint32_t from = kNoTriangle, to = kNoTriangle;
  float shownFrom = kFar;  ///< passes such backs from here on, lengths of the direction
};

bool atHiddenBack(const Surfaces& surfaces, uint32_t triangle, const glm::dvec3& direction) {
  return surfaces.singleSided(triangle) && glm::dot(direction, surfaces.triangles()[triangle].normal) >= 0;
}

void pass(const RTCFilterFunctionNArguments* arguments) {
  const auto& passing = *reinterpret_cast<const Passing*>(arguments->context);
  const Surfaces& surfaces = *passing.surfaces;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const glm::dvec2 uv(RTCHitN_u(arguments->hit, arguments->N, i), RTCHitN_v(arguments->hit, arguments->N, i));
    const glm::dvec3 direction(RTCRayN_dir_x(arguments->ray, arguments->N, i),
                               RTCRayN_dir_y(arguments->ray, arguments->N, i),
                               RTCRayN_dir_z(arguments->ray, arguments->N, i));
    const bool through = triangle == passing.from || triangle == passing.to ||
                         (RTCRayN_tfar(arguments->ray, arguments->N, i) >= passing.shownFrom &&
                          atHiddenBack(surfaces, triangle, direction)) ||
                         surfaces.cutOut(triangle, uv);
    if (through) arguments->valid[i] = 0;
  }
}

struct Met {
  uint32_t triangle = kNoTriangle;
  glm::dvec2 uv{0};
};

/// A direction about `normal` with density cosine / pi.
glm::dvec3 cosineDirection(const glm::dvec3& normal, Random& random) {
  const double r2 = random.next(), r = std::sqrt(r2), phi = 2 * std::numbers::pi * random.next();
  const glm::dvec3 aside = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 t = glm::normalize(glm::cross(normal, aside)), b = glm::cross(normal, t);
  return r * std::cos(phi) * t + r * std::sin(phi) * b + std::sqrt(std::max(0.0, 1 - r2)) * normal;
}

void makeRoom(TracedSums& sums, glm::uvec2 size) {
  sums.size = size;
  const size_t pixels = size_t{size.x} * size.y;
  for (TracedSums::Light* light : {&sums.lit, &sums.indirect})
    for (auto* values : {&light->half[0], &light->half[1], &light->squares}) values->assign(pixels, glm::dvec3(0));
}

class EmbreeTracer : public PathTracer {
 public:
  EmbreeTracer(Scene scene, Sky sky)
      : surfaces_(std::move(scene)), sky_(std::move(sky)), scene_(surfaces_.scene().positions, corners(surfaces_)) {}

  void add(const Camera& camera, glm::uvec2 size, const TraceOptions& options, TracedSums& sums) const override {
    const auto start = std::chrono::steady_clock::now();
    if (sums.samples == 0) makeRoom(sums, size);
    IRAD_CHECK(sums.size == size, "sums of {} x {} pixels for {} x {}", sums.size.x, sums.size.y, size.x, size.y);
    std::atomic<uint32_t> nextRow = 0;
    std::atomic<uint64_t> rays = 0;
    const auto work = [&] {
      for (uint32_t y; (y = nextRow++) < size.y;) {
        Paths paths(*this, camera, size, options);
        for (uint32_t x = 0; x < size.x; ++x) paths.pixel({x, y}, sums);
        rays += paths.rays;
      }
    };
    const uint32_t count = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    {
      std::vector<std::jthread> others;
      for (uint32_t t = 1; t < count; ++t) others.emplace_back(work);
      work();
    }
    sums.samples += options.samples;
    sums.rays += rays;
    sums.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

 private:
  static std::vector<uint32_t> corners(const Surfaces& surfaces) {
    std::vector<uint32_t> indices;
    for (const truth::Triangle& t : surfaces.triangles())
      for (int k = 0; k < 3; ++k) indices.push_back(t.corner[k]);
    return indices;
  }

  /// The paths of some pixels.
  struct Paths {
    Paths(const EmbreeTracer& tracer, const Camera& camera, glm::uvec2 size, const TraceOptions& options)
        : tracer(tracer), surfaces(tracer.surfaces_), sky(tracer.sky_), camera(camera), size(size), options(options) {}
    const EmbreeTracer& tracer;
    const Surfaces& surfaces;
    const SkyLight& sky;
    const Camera& camera;
    const glm::uvec2 size;
    const TraceOptions& options;
    uint64_t rays = 0;
    glm::dvec3 lit{0}, indirect{0};  ///< of the path in hand

    void pixel(glm::uvec2 at, TracedSums& sums) {
      const size_t index = size_t{at.y} * size.x + at.x;
      for (uint32_t s = sums.samples; s < sums.samples + options.samples; ++s) {
        Random random(options.seed, uint64_t{s} << 32 | index);
        lit = indirect = glm::dvec3(0);
        path(at, random);
        put(lit, sums.lit, index, s);
        put(indirect, sums.indirect, index, s);
      }
    }
    static void put(const glm::dvec3& light, TracedSums::Light& sums, size_t index, uint32_t sample) {
      sums.half[sample % 2][index] += light;
      sums.squares[index] += light * light;
    }

    RTCRay ray(const glm::dvec3& origin, const glm::dvec3& direction, float near, float far) {
      ++rays;
      return EmbreeScene::ray(origin, direction, near, far);
    }
    Passing passing(uint32_t from, uint32_t to, float shownFrom) const {
      Passing p{.context = {}, .surfaces = &surfaces, .from = from, .to = to, .shownFrom = shownFrom};
      rtcInitIntersectContext(&p.context);
      p.context.filter = pass;
      return p;
    }

    /// `t`: where.
    Met meet(const glm::dvec3& origin, const glm::dvec3& direction, float near, float far, uint32_t from,
             float shownFrom, float& t) {
      Passing p = passing(from, kNoTriangle, shownFrom);
      RTCRayHit hit{.ray = ray(origin, direction, near, far), .hit = {}};
      hit.hit.geomID = hit.hit.primID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(tracer.scene_.handle(), &p.context, &hit);
      t = hit.ray.tfar;
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
      return {hit.hit.primID, {hit.hit.u, hit.hit.v}};
    }
    /// Within what distance of a triangle, along a ray from another, faces may lie in its plane but for rounding.
    float around(uint32_t from, uint32_t to, double cosine) const {
      return static_cast<float>(std::max(surfaces.offset(from), surfaces.offset(to)) / std::max(cosine, 1e-2));
    }
    /// From triangle `from` on. Of two faces in one plane the side that shows is met, whatever the distances round to.
    Met meetNext(const glm::dvec3& origin, const glm::dvec3& direction, uint32_t from) {
      float t;
      const Met met = meet(origin, direction, 0, kFar, from, kFar, t);
      if (met.triangle == kNoTriangle || !atHiddenBack(surfaces, met.triangle, direction)) return met;
      const float d = around(from, met.triangle, glm::dot(direction, surfaces.triangles()[met.triangle].normal));
      const Met shown = meet(origin, direction, std::max(0.0f, t - d), t + d, from, /*shownFrom=*/0, t);
      return shown.triangle == kNoTriangle ? met : shown;
    }
    /// Whether nothing lies on the first `far` lengths of `direction`, but for hidden backs from `shownFrom` on.
    bool clear(const glm::dvec3& origin, const glm::dvec3& direction, float far, uint32_t from, uint32_t to,
               float shownFrom) {
      Passing p = passing(from, to, shownFrom);
      RTCRay shadow = ray(origin, direction, 0, far);
      rtcOccluded1(tracer.scene_.handle(), &p.context, &shadow);
      return shadow.tfar >= 0;
    }

    void add(const glm::dvec3& light, bool bounced) {
      lit += light;
      if (bounced) indirect += light;
    }

    void path(glm::uvec2 at, Random& random) {
      // The camera's ray. Its direction has length 1 along the view, so that distances are depths.
      const glm::dvec2 within = options.centred ? glm::dvec2(0.5) : glm::dvec2(random.next(), random.next());
      const glm::dvec2 p = (glm::dvec2(at) + within) / glm::dvec2(size) * glm::dvec2(2, -2) + glm::dvec2(-1, 1);
      const glm::dmat3 axes = glm::mat3_cast(glm::dquat(glm::normalize(camera.orientation)));
      const double high = camera.orthographic ? camera.ymag : std::tan(0.5 * camera.yfov);
      const glm::dvec3 aside = axes[0] * (p.x * high * size.x / size.y) + axes[1] * (p.y * high);
      glm::dvec3 origin = camera.position - surfaces.scene().origin;
      glm::dvec3 direction = -axes[2];
      (camera.orthographic ? origin : direction) += aside;
      const float far = camera.zfar > camera.znear ? camera.zfar : kFar;
      float depth1;
      Met met = meet(origin, direction, std::max(camera.znear, 0.0f), far, kNoTriangle, /*shownFrom=*/0, depth1);
      direction = glm::normalize(direction);

      glm::dvec3 throughput(1);
      double bounceDensity = 0;  // per steradian, of the direction that led here
      uint32_t depth = 0;
      for (; met.triangle != kNoTriangle; ++depth) {
        const SurfacePoint point = surfaces.at(met.triangle, met.uv, direction);
        // Emission that the ray has come upon. From the second vertex on it may have been drawn there, too.
        if (point.emission != glm::dvec3(0)) {
          double weight = 1;
          if (depth > 0) {
            const glm::dvec3 way = point.position - origin;
            const double cosine = std::abs(glm::dot(direction, point.face));
            const double drawn = surfaces.emitterDensity(met.triangle) * glm::dot(way, way);  // x cosine
            weight = bounceDensity * cosine / (bounceDensity * cosine + drawn);
          }
          add(throughput * point.emission * weight, depth > 0);
        }
        if (point.albedo == glm::dvec3(0)) return;
        origin = point.position + point.face * surfaces.offset(met.triangle);
        const glm::dvec3 reflected = throughput * point.albedo / std::numbers::pi;
        for (size_t l = 0; l < surfaces.lights(); ++l)
          fromLight(l, point, met.triangle, origin, reflected, random, depth > 0);
        if (surfaces.emits()) fromEmitter(point, met.triangle, origin, reflected, random);
        if (sky.shines()) fromSky(point, met.triangle, origin, reflected, random);

        // Go on in proportion to the cosine; the albedo is what is left of the weight. From the fourth bounce on a path
        // survives with the probability of its largest channel.
        direction = cosineDirection(point.normal, random);
        throughput *= point.albedo;
        if (glm::dot(direction, point.face) <= 0) return;
        throughput *= pastBumps(point, direction);
        if (depth >= 3) {
          const double survive = std::min(1.0, std::max({throughput.x, throughput.y, throughput.z}));
          if (random.next() >= survive) return;
          throughput /= survive;
        }
        bounceDensity = glm::dot(direction, point.normal) / std::numbers::pi;
        met = meetNext(origin, direction, met.triangle);
      }
      // The sky that the ray has come upon, which from the second vertex on may have been drawn, too.
      if (!sky.shines()) return;
      const double drawn = depth > 0 ? sky.density(direction) : 0;
      add(throughput * sky.radiance(direction) * (depth > 0 ? bounceDensity / (bounceDensity + drawn) : 1), depth > 0);
    }

    void fromSky(const SurfacePoint& point, uint32_t from, const glm::dvec3& origin, const glm::dvec3& reflected,
                 Random& random) {
      const SkyLight::Drawn drawn = sky.draw(random);
      const double cosine = glm::dot(point.normal, drawn.direction);
      if (cosine <= 0 || glm::dot(point.face, drawn.direction) <= 0) return;
      if (!clear(origin, drawn.direction, kFar, from, kNoTriangle, kFar)) return;
      // The balance heuristic, as in fromEmitter.
      add(reflected * sky.radiance(drawn.direction) * cosine * pastBumps(point, drawn.direction) /
              (drawn.density + cosine / std::numbers::pi),
          /*bounced=*/true);
    }

    void fromLight(size_t light, const SurfacePoint& point, uint32_t from, const glm::dvec3& origin,
                   const glm::dvec3& reflected, Random& random, bool bounced) {
      const auto arriving = surfaces.arriving(light, point.position, random);
      if (!arriving) return;
      const double cosine = glm::dot(point.normal, arriving->towards);
      if (cosine <= 0 || glm::dot(point.face, arriving->towards) <= 0) return;
      const float far = std::isfinite(arriving->distance) ? static_cast<float>(arriving->distance) : kFar;
      if (clear(origin, arriving->towards, far, from, kNoTriangle, kFar))
        add(reflected * arriving->irradiance * cosine * pastBumps(point, arriving->towards), bounced);
    }

    void fromEmitter(const SurfacePoint& point, uint32_t from, const glm::dvec3& origin, const glm::dvec3& reflected,
                     Random& random) {
      const truth::EmitterPoint drawn = surfaces.drawEmitter(random);
      const glm::dvec3 way = drawn.position - origin;
      const double d2 = glm::dot(way, way), distance = std::sqrt(d2);
      if (!(distance > 0) || drawn.triangle == from) return;
      const glm::dvec3 towards = way / distance;
      const double cosine = glm::dot(point.normal, towards);
      if (cosine <= 0 || glm::dot(point.face, towards) <= 0 || surfaces.cutOut(drawn.triangle, drawn.uv)) return;
      const SurfacePoint there = surfaces.at(drawn.triangle, drawn.uv, towards);
      const double cosineThere = -glm::dot(there.face, towards);
      if (there.emission == glm::dvec3(0) || !(cosineThere > 0)) return;
      // Just short of the other triangle, lest its neighbour in the same plane is in the way.
      const auto far = static_cast<float>(distance * (1 - 0x1p-20));
      if (!clear(origin, towards, far, from, drawn.triangle, far - around(from, drawn.triangle, cosineThere))) return;
      // Both densities per steradian: the balance heuristic's weight over the drawn one is 1 / (their sum).
      const double density = drawn.density * d2 / cosineThere + cosine / std::numbers::pi;
      add(reflected * there.emission * cosine * pastBumps(point, towards) / density, /*bounced=*/true);
    }
  };

  Surfaces surfaces_;
  SkyLight sky_;
  EmbreeScene scene_;
};

}  // namespace

bool hasPathTracer() {
  return true;
}

std::unique_ptr<PathTracer> makePathTracer(Scene scene, Sky sky) {
  return std::make_unique<EmbreeTracer>(std::move(scene), std::move(sky));
}

}  // namespace irad
