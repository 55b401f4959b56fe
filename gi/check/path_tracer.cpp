#include "gi/check/path_tracer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "gi/check/path_lobe.h"
#include "gi/check/path_sky.h"
#include "gi/check/path_surfaces.h"
#include "gi/embree_scene.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

using truth::kNoTriangle;
using truth::Lobe;
using truth::PathVertex;
using truth::Random;
using truth::SkyLight;
using truth::Surfaces;

/// Keeps what decides at blended surfaces apart from a path's other random numbers, which are the same without them.
constexpr uint64_t kChance = 0x6a09e667f3bcc909;

constexpr float kFar = std::numeric_limits<float>::infinity();

/// What a ray passes through: the triangle that it leaves, the one that it goes to, holes of masks, blended surfaces by
/// chance, and from some distance on hidden backs, those of single-sided faces.
struct Passing {
  /// A pane, by which some of the light has been let through.
  struct Pane {
    uint32_t triangle;
    float t;
    glm::dvec3 tint;
  };

  RTCIntersectContext context;  // first: Embree hands back its address
  const Surfaces* surfaces;
  uint32_t from = kNoTriangle, to = kNoTriangle;
  uint64_t chance = 0, segment = 0;  ///< of the path, and of its rays: what decides at blended surfaces
  float shownFrom = kFar;            ///< passes such backs from here on, lengths of the direction

  std::vector<Pane>* panes = nullptr;  ///< that it has come upon, in any order, also behind what it meets

  bool goesBy(uint32_t triangle, glm::dvec2 uv, float t) const;
  /// What they leave of light from `far` lengths away.
  glm::dvec3 tint(float far) const;
};

/// At each triangle anew, by its alpha, and by the channel that it lets through most of.
bool Passing::goesBy(uint32_t triangle, glm::dvec2 uv, float t) const {
  const double cover = surfaces->cover(triangle, uv);
  if (Random(chance, segment << 32 | triangle).next() < cover) return false;
  const glm::dvec3 tint = surfaces->passing(triangle, uv) / (1 - cover);
  const auto known = [&](const Pane& pane) { return pane.triangle == triangle; };
  if (tint != glm::dvec3(1) && std::ranges::none_of(*panes, known)) panes->push_back({triangle, t, tint});
  return true;
}

glm::dvec3 Passing::tint(float far) const {
  glm::dvec3 tint(1);
  for (const Pane& pane : *panes)
    if (pane.t < far) tint *= pane.tint;
  return tint;
}

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
    const bool through =
        triangle == passing.from || triangle == passing.to ||
        (RTCRayN_tfar(arguments->ray, arguments->N, i) >= passing.shownFrom &&
         atHiddenBack(surfaces, triangle, direction)) ||
        surfaces.cutOut(triangle, uv) ||
        (surfaces.blended(triangle) && passing.goesBy(triangle, uv, RTCRayN_tfar(arguments->ray, arguments->N, i)));
    if (through) arguments->valid[i] = 0;
  }
}

struct Met {
  uint32_t triangle = kNoTriangle;
  glm::dvec2 uv{0};
  glm::dvec3 tint{1};  ///< of what lies on the way
};

/// The most that a path survives with: even between perfect mirrors it ends.
constexpr double kMostSurvival = 0.98;
/// The least and the most that a vertex with both parts chooses the lobe with.
constexpr double kLeastChoice = 0.1;

/// A direction about `normal` with density cosine / pi.
glm::dvec3 cosineDirection(const glm::dvec3& normal, Random& random) {
  const double r2 = random.next(), r = std::sqrt(r2), phi = 2 * std::numbers::pi * random.next();
  const glm::dmat3 frame = truth::frameAbout(normal);
  return r * std::cos(phi) * frame[0] + r * std::sin(phi) * frame[1] + std::sqrt(std::max(0.0, 1 - r2)) * normal;
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Where a path has come to.
struct Vertex {
  PathVertex point;
  Lobe lobe;              ///< none with TraceOptions::glossy off
  double lobeChoice = 0;  ///< probability that the path goes on by the lobe
  uint32_t triangle = kNoTriangle, depth = 0;
  glm::dvec3 origin{0};      ///< of rays from here
  glm::dvec3 throughput{1};  ///< to here
  glm::dvec3 reflected{0};   ///< by the diffuse part, of irradiance

  /// Per steradian, that the path goes on this way, but for a mirror.
  double density(const glm::dvec3& towards, double cosine) const {
    if (lobeChoice == 0) return cosine / std::numbers::pi;
    return lobeChoice * lobe.density(towards) + (1 - lobeChoice) * cosine / std::numbers::pi;
  }
  glm::dvec3 diffuse(const glm::dvec3& light, const glm::dvec3& towards, double cosine) const {
    return reflected * light * cosine * truth::pastBumps(point, towards);
  }
  glm::dvec3 specular(const glm::dvec3& light, const glm::dvec3& towards, double cosine) const {
    return lobe ? throughput * light * lobe.value(towards) * cosine : glm::dvec3(0);
  }
};

void makeRoom(TracedSums& sums, glm::uvec2 size, const TraceOptions& options) {
  sums.size = size;
  sums.bounces.resize(options.bounces);
  const auto make = [&](TracedSums::Light& light) {
    for (auto* values : {&light.half[0], &light.half[1], &light.squares})
      values->assign(size_t{size.x} * size.y, glm::dvec3(0));
  };
  make(sums.lit);
  make(sums.indirect);
  if (options.glossy) make(sums.specular);
  for (TracedSums::Light& light : sums.bounces) make(light);
}

class EmbreeTracer : public PathTracer {
 public:
  EmbreeTracer(Scene scene, Sky sky)
      : surfaces_(std::move(scene)), sky_(std::move(sky)), scene_(surfaces_.scene().positions, corners(surfaces_)) {}

  void add(const Camera& camera, glm::uvec2 size, const TraceOptions& options, TracedSums& sums) const override {
    const auto start = std::chrono::steady_clock::now();
    if (sums.samples == 0) makeRoom(sums, size, options);
    IRAD_CHECK(sums.size == size, "sums of {} x {} pixels for {} x {}", sums.size.x, sums.size.y, size.x, size.y);
    IRAD_CHECK(sums.bounces.size() == options.bounces && sums.specular.squares.empty() != options.glossy,
               "sums of other light than is asked for");
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
    uint64_t chance = 0, segment = 0;             ///< Passing's, of the path in hand
    std::vector<Passing::Pane> panes;             ///< of the ray in hand
    glm::dvec3 lit{0}, indirect{0}, specular{0};  ///< of the path in hand
    std::vector<glm::dvec3> bounces = std::vector<glm::dvec3>(options.bounces);
    glm::dvec3 diffuseShare{1};  ///< of its throughput: by the diffuse part of what is seen

    void pixel(glm::uvec2 at, TracedSums& sums) {
      const size_t index = size_t{at.y} * size.x + at.x;
      for (uint32_t s = sums.samples; s < sums.samples + options.samples; ++s) {
        Random random(options.seed, uint64_t{s} << 32 | index);
        chance = Random(options.seed ^ kChance, uint64_t{s} << 32 | index).bits();
        segment = 0;
        lit = indirect = specular = glm::dvec3(0);
        diffuseShare = glm::dvec3(1);
        std::ranges::fill(bounces, glm::dvec3(0));
        path(at, random);
        put(lit, sums.lit, index, s);
        put(indirect, sums.indirect, index, s);
        if (options.glossy) put(specular, sums.specular, index, s);
        for (size_t k = 0; k < bounces.size(); ++k) put(bounces[k], sums.bounces[k], index, s);
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
    Passing passing(uint32_t from, uint32_t to, float shownFrom) {
      panes.clear();
      Passing p{.context = {},
                .surfaces = &surfaces,
                .from = from,
                .to = to,
                .chance = chance,
                .segment = segment,
                .shownFrom = shownFrom,
                .panes = &panes};
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
      const glm::dvec3 tint = p.tint(t);
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {.tint = tint};
      return {hit.hit.primID, {hit.hit.u, hit.hit.v}, tint};
    }
    /// Within what distance of a triangle, along a ray from another, faces may lie in its plane but for rounding.
    float around(uint32_t from, uint32_t to, double cosine) const {
      return static_cast<float>(std::max(surfaces.offset(from), surfaces.offset(to)) / std::max(cosine, 1e-2));
    }
    /// From triangle `from` on. Of two faces in one plane the side that shows is met, whatever the distances round to.
    Met meetNext(const glm::dvec3& origin, const glm::dvec3& direction, uint32_t from) {
      float t;
      ++segment;
      const Met met = meet(origin, direction, 0, kFar, from, kFar, t);
      if (met.triangle == kNoTriangle || !atHiddenBack(surfaces, met.triangle, direction)) return met;
      const float d = around(from, met.triangle, glm::dot(direction, surfaces.triangles()[met.triangle].normal));
      Met shown = meet(origin, direction, std::max(0.0f, t - d), t + d, from, /*shownFrom=*/0, t);
      if (shown.triangle == kNoTriangle) return met;
      shown.tint = met.tint;
      return shown;
    }
    /// What arrives over the first `far` lengths of `direction`, hidden backs apart from `shownFrom` on: 0 where
    /// anything lies there, less than 1 through panes.
    glm::dvec3 clear(const glm::dvec3& origin, const glm::dvec3& direction, float far, uint32_t from, uint32_t to,
                     float shownFrom) {
      ++segment;
      Passing p = passing(from, to, shownFrom);
      RTCRay shadow = ray(origin, direction, 0, far);
      rtcOccluded1(tracer.scene_.handle(), &p.context, &shadow);
      return shadow.tfar >= 0 ? p.tint(kFar) : glm::dvec3(0);
    }

    /// Light that the path has come upon at a depth.
    void come(const glm::dvec3& light, uint32_t depth) {
      lit += light;
      if (depth > 0) {
        indirect += light * diffuseShare;
        if (options.glossy) specular += light * (1.0 - diffuseShare);
      }
      count(light, depth > 0 ? depth - 1 : 0);
    }
    /// Light that a vertex reflects, by either part. `punctual`: from a sun, point or spot.
    void reflect(const Vertex& v, const glm::dvec3& diffuse, const glm::dvec3& glossy, bool punctual) {
      const glm::dvec3 light = diffuse + glossy;
      lit += light;
      count(light, v.depth);
      if (v.depth == 0) {
        if (punctual) return;
        indirect += diffuse;
        specular += glossy;
      } else {
        indirect += light * diffuseShare;
        if (options.glossy) specular += light * (1.0 - diffuseShare);
      }
    }
    void count(const glm::dvec3& light, uint32_t reflections) {
      if (reflections < bounces.size()) bounces[reflections] += light;
    }

    /// What drawn light is divided by, which may also be come upon: the balance heuristic's weight over the density
    /// drawn with is 1 / (the sum of both).
    double dividedBy(double drawn, double bounce) const {
      return options.strategy == TraceStrategy::lights ? drawn : drawn + bounce;
    }
    /// The weight of light come upon that may also be drawn.
    double weightOf(double bounce, double drawn) const {
      switch (options.strategy) {
        case TraceStrategy::lights:
          return 0;
        case TraceStrategy::bounces:
          return 1;
        case TraceStrategy::both:
          break;
      }
      return bounce / (bounce + drawn);
    }
    bool draws() const { return options.strategy != TraceStrategy::bounces; }

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

      Vertex v;
      double bounceDensity = 0;  // per steradian, of the direction that led here
      bool mayBeDrawn = false;   // what lies here could have been drawn at the vertex before
      v.throughput *= met.tint;
      for (; met.triangle != kNoTriangle; ++v.depth) {
        const PathVertex& point = v.point = surfaces.at(met.triangle, met.uv, direction);
        v.triangle = met.triangle;
        // Emission that the ray has come upon. From the second vertex on it may have been drawn there, too.
        if (point.emission != glm::dvec3(0)) {
          double weight = 1;
          if (mayBeDrawn) {
            const glm::dvec3 way = point.position - v.origin;
            const double cosine = std::abs(glm::dot(direction, point.face));
            const double drawn = surfaces.emitterDensity(met.triangle) * glm::dot(way, way);  // x cosine
            weight = weightOf(bounceDensity * cosine, drawn);
          }
          come(v.throughput * point.emission * weight, v.depth);
        }
        if (options.glossy) findLobe(v, met.uv, direction);
        if (point.albedo == glm::dvec3(0) && !v.lobe) return;
        v.origin = point.position + point.face * surfaces.offset(met.triangle);
        v.reflected = v.throughput * point.albedo / std::numbers::pi;
        for (size_t l = 0; l < surfaces.lights(); ++l) fromLight(l, v, random);
        if (surfaces.emits() && draws()) fromEmitter(v, random);
        if (sky.shines() && draws()) fromSky(v, random);

        mayBeDrawn = true;
        if (!(v.lobe ? goOnGlossy(v, random, direction, bounceDensity, mayBeDrawn) : goOn(v, random, direction)))
          return;
        // From the fourth bounce on a path survives with the probability of its largest channel.
        if (v.depth >= 3) {
          const double survive = std::min(kMostSurvival, largest(v.throughput));
          if (random.next() >= survive) return;
          v.throughput /= survive;
        }
        if (!v.lobe) bounceDensity = glm::dot(direction, point.normal) / std::numbers::pi;
        met = meetNext(v.origin, direction, met.triangle);
        v.throughput *= met.tint;
      }
      // The sky that the ray has come upon, which from the second vertex on may have been drawn, too.
      if (!sky.shines()) return;
      const double drawn = mayBeDrawn ? sky.density(direction) : 0;
      come(v.throughput * sky.radiance(direction) * (mayBeDrawn ? weightOf(bounceDensity, drawn) : 1), v.depth);
    }

    void findLobe(Vertex& v, glm::dvec2 uv, const glm::dvec3& direction) const {
      v.lobe = {};
      v.lobeChoice = 0;
      if (options.glossySeen && v.depth > 0) return;
      const auto gloss = surfaces.glossAt(v.triangle, uv, direction);
      if (!gloss) return;
      const Lobe lobe(gloss->f0, gloss->roughness, v.point.normal, -direction, gloss->weight);
      const double shine = largest(lobe.reflectance()), diffuse = largest(v.point.albedo);
      if (!(shine > 0)) return;
      v.lobe = lobe;
      v.lobeChoice = diffuse > 0 ? std::clamp(shine / (shine + diffuse), kLeastChoice, 1 - kLeastChoice) : 1;
    }

    /// In proportion to the cosine; the albedo is what is left of the weight. False: the path ends.
    static bool goOn(Vertex& v, Random& random, glm::dvec3& direction) {
      direction = cosineDirection(v.point.normal, random);
      v.throughput *= v.point.albedo;
      if (glm::dot(direction, v.point.face) <= 0) return false;
      v.throughput *= truth::pastBumps(v.point, direction);
      return true;
    }
    /// By the lobe or in proportion to the cosine; what either could have done weighs on both.
    bool goOnGlossy(Vertex& v, Random& random, glm::dvec3& direction, double& density, bool& mayBeDrawn) {
      const bool byLobe = v.lobeChoice == 1 || random.next() < v.lobeChoice;
      direction = byLobe ? v.lobe.draw(random) : cosineDirection(v.point.normal, random);
      const double cosine = glm::dot(direction, v.point.normal);
      if (cosine <= 0 || glm::dot(direction, v.point.face) <= 0) return false;
      glm::dvec3 diffuse(0), glossy(0);
      if (byLobe && v.lobe.mirror()) {
        mayBeDrawn = false;
        glossy = v.lobe.mirrored() / v.lobeChoice;
      } else {
        density = v.density(direction, cosine);
        if (!(density > 0)) return false;
        diffuse = v.point.albedo / std::numbers::pi * cosine * truth::pastBumps(v.point, direction) / density;
        glossy = v.lobe.value(direction) * cosine / density;
      }
      const glm::dvec3 all = diffuse + glossy;
      if (v.depth == 0)
        for (int c = 0; c < 3; ++c) diffuseShare[c] = all[c] > 0 ? diffuse[c] / all[c] : 0;
      v.throughput *= all;
      return largest(v.throughput) > 0;
    }

    void fromSky(const Vertex& v, Random& random) {
      const SkyLight::Drawn drawn = sky.draw(random);
      const double cosine = glm::dot(v.point.normal, drawn.direction);
      if (cosine <= 0 || glm::dot(v.point.face, drawn.direction) <= 0) return;
      const glm::dvec3 tint = clear(v.origin, drawn.direction, kFar, v.triangle, kNoTriangle, kFar);
      if (tint == glm::dvec3(0)) return;
      reflectDrawn(v, tint * sky.radiance(drawn.direction), drawn.direction, cosine, drawn.density);
    }

    void reflectDrawn(const Vertex& v, const glm::dvec3& radiance, const glm::dvec3& towards, double cosine,
                      double drawn) {
      const double density = dividedBy(drawn, v.density(towards, cosine));
      reflect(v, v.diffuse(radiance, towards, cosine) / density, v.specular(radiance, towards, cosine) / density,
              /*punctual=*/false);
    }

    void fromLight(size_t light, const Vertex& v, Random& random) {
      auto arriving = surfaces.arriving(light, v.point.position, random);
      if (!arriving) return;
      const glm::dvec3& towards = arriving->towards;
      const double cosine = glm::dot(v.point.normal, towards);
      if (cosine <= 0 || glm::dot(v.point.face, towards) <= 0) return;
      const float far = std::isfinite(arriving->distance) ? static_cast<float>(arriving->distance) : kFar;
      const glm::dvec3 tint = clear(v.origin, towards, far, v.triangle, kNoTriangle, kFar);
      if (tint == glm::dvec3(0)) return;
      arriving->irradiance *= tint;
      glm::dvec3 glossy(0);
      if (v.lobe) glossy = v.throughput * arriving->irradiance * v.lobe.valueOfPoint(towards) * cosine;
      reflect(v, v.diffuse(arriving->irradiance, towards, cosine), glossy, /*punctual=*/true);
    }

    void fromEmitter(const Vertex& v, Random& random) {
      const truth::EmitterPoint drawn = surfaces.drawEmitter(random);
      const glm::dvec3 way = drawn.position - v.origin;
      const double d2 = glm::dot(way, way), distance = std::sqrt(d2);
      if (!(distance > 0) || drawn.triangle == v.triangle) return;
      const glm::dvec3 towards = way / distance;
      const double cosine = glm::dot(v.point.normal, towards);
      if (cosine <= 0 || glm::dot(v.point.face, towards) <= 0 || surfaces.cutOut(drawn.triangle, drawn.uv)) return;
      PathVertex there = surfaces.at(drawn.triangle, drawn.uv, towards);
      if (surfaces.blended(drawn.triangle)) there.emission *= surfaces.cover(drawn.triangle, drawn.uv);
      const double cosineThere = -glm::dot(there.face, towards);
      if (there.emission == glm::dvec3(0) || !(cosineThere > 0)) return;
      // Just short of the other triangle, lest its neighbour in the same plane is in the way.
      const auto far = static_cast<float>(distance * (1 - 0x1p-20));
      const glm::dvec3 tint = clear(v.origin, towards, far, v.triangle, drawn.triangle,
                                    far - around(v.triangle, drawn.triangle, cosineThere));
      if (tint == glm::dvec3(0)) return;
      reflectDrawn(v, tint * there.emission, towards, cosine, drawn.density * d2 / cosineThere);
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
