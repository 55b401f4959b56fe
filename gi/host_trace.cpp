#include "gi/host_trace.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "gi/embree_scene.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/oracle/rays.h"
#include "renderer/base/error.h"
#include "renderer/base/parallel.h"
#include "renderer/frame/context.h"
#include "renderer/resources.h"
#include "shaders/forward/light.h"
#include "shaders/shared/sky.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

/// Rows that a thread takes at once.
constexpr uint32_t kBlock = 16;
/// Rays that go down the tree together, in the order of the set, which is spread over the hemisphere: a fifth faster
/// than one by one; 16, Embree's streams, and rays sorted by direction are no faster than this.
constexpr uint32_t kPacket = 8;

Triangle triangleAt(const oracle::Facets& facets, uint32_t triangle) {
  const glm::vec4* corner = &facets.corners[3 * size_t{triangle}];
  return {glm::vec3(corner[0]), glm::vec3(corner[1]), glm::vec3(corner[2])};
}

/// A triangle's part in one voxel.
struct Piece {
  uint32_t index, firstFacet;  ///< firstFacet: of the voxel
  glm::ivec3 voxel;
};

std::optional<Piece> pieceIn(const oracle::Facets& facets, const glm::ivec3& voxel, uint32_t triangle) {
  if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) ||
      glm::any(glm::greaterThanEqual(voxel, glm::ivec3(facets.grid.dims))))
    return std::nullopt;
  const uint32_t entry = facets.reverse[voxelIndex(glm::uvec3(voxel), facets.grid.dims)];
  if (entry == NO_FACET) return std::nullopt;
  const uint32_t facet = firstFacet(entry);
  const auto begin = facets.pieces.begin() + facets.firstPiece[facet];
  const auto end = facets.pieces.begin() + facets.firstPiece[facet + facetsOf(entry)];
  for (const uint32_t piece : {triangle, triangle | PIECE_SMALL}) {
    const auto found = std::lower_bound(begin, end, piece);
    if (found != end && *found == piece)
      return Piece{static_cast<uint32_t>(found - facets.pieces.begin()), facet, voxel};
  }
  return std::nullopt;
}

/// The triangle's piece at one of its points: in the voxel that holds it or, where rounding has put it into another,
/// the next one. None: the triangle is too thin to be listed.
std::optional<Piece> listedAt(const oracle::Facets& facets, const glm::vec3& at, uint32_t triangle) {
  const glm::vec3 cell = glm::floor(at), within = at - cell;
  if (const std::optional<Piece> piece = pieceIn(facets, cell, triangle)) return piece;
  const float rounding = facets.hasHoles(triangle) ? 1e-4f : 1e-2f;
  const glm::ivec3 beside = glm::ivec3(glm::greaterThan(within, glm::vec3(1 - rounding))) -
                            glm::ivec3(glm::lessThan(within, glm::vec3(rounding)));
  for (int i = 1; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
    if (corner * glm::abs(beside) != corner) continue;
    if (const std::optional<Piece> piece = pieceIn(facets, glm::ivec3(cell) + corner * beside, triangle)) return piece;
  }
  return std::nullopt;
}

/// The same where a mask leaves it. `closed`: to what it is closed of a pane that lets the ray pass.
std::optional<Piece> pieceAt(const oracle::Facets& facets, const glm::vec3& at, uint32_t triangle,
                             uint32_t* closed = nullptr) {
  const std::optional<Piece> piece = listedAt(facets, at, triangle);
  if (!piece || !facets.hasHoles(triangle)) return piece;
  const glm::vec3 normal = facingOf(triangleAt(facets, triangle), false);
  const uint32_t bit = maskBit(normal, at - glm::vec3(piece->voxel));
  if (facets.maskLeaves(piece->index, bit)) return piece;
  if (closed != nullptr && facets.isTinted(triangle)) *closed = facets.closedChannels(piece->index, bit);
  return std::nullopt;
}

/// gi/piece_cuts.h.
uint32_t classAt(const oracle::Facets& facets, uint32_t piece, bool back, const glm::vec3& at) {
  const uint32_t sides = facets.sides[piece], shift = back ? 8 : 0;
  if ((sides & PIECE_CUT) == 0) return (sides >> shift) & 0xFFu;
  const oracle::Facets::Cuts cuts = facets.cutsOf(piece);
  uint32_t part = 0;
  for (uint32_t i = 0; i < cuts.triangles.size(); ++i) {
    const Triangle t = triangleAt(facets, cuts.triangles[i]);
    const float side = glm::dot(facingOf(t, false), at - t.a);
    if (std::abs(side) < CUT_WIDTH) return PIECE_UNKNOWN;
    part |= side > 0 ? 1u << i : 0u;
  }
  return cuts.facet(part, back);
}

/// Whether a ray comes upon a side that does not show. `normal`: of the front.
bool atHiddenBack(const oracle::Facets& facets, const HostRay& ray, uint32_t triangle, const glm::vec3& normal) {
  return glm::dot(normal, ray.direction) > 0 && !facets.showsBack(triangle);
}

/// What a ray leaves to what lies outside the grid, by distances: before the first, after the second.
glm::vec2 ofGrid(const oracle::Facets& facets, const HostRay& ray) {
  const glm::vec3 d =
      glm::mix(ray.direction, glm::vec3(1e-9f), glm::lessThan(glm::abs(ray.direction), glm::vec3(1e-9f)));
  return throughGrid(facets.grid.dims, ray.origin, 1.0f / d);
}
bool isOutside(const glm::vec2& grid, float t) {
  return t < grid.x || t > grid.y;
}

/// For a ray that passes through the triangle that it leaves, or through triangles where they have no piece.
struct PassedThrough {
  RTCIntersectContext context;  // first: Embree hands back its address
  const oracle::Facets* facets;
  const HostRay* ray;
  bool hiddenBacks;               ///< through these, too
  std::optional<glm::vec2> grid;  ///< ofGrid, where something lies outside
  /// Panes that have kept channels off, where, in any order, also behind what the ray meets.
  struct Pane {
    float t;
    uint32_t closed;
  };
  std::vector<Pane>* panes = nullptr;
};

void passThrough(const RTCFilterFunctionNArguments* arguments) {
  const auto& passed = *reinterpret_cast<const PassedThrough*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const float t = RTCRayN_tfar(arguments->ray, arguments->N, i);
    const glm::vec3 normal(RTCHitN_Ng_x(arguments->hit, arguments->N, i), RTCHitN_Ng_y(arguments->hit, arguments->N, i),
                           RTCHitN_Ng_z(arguments->hit, arguments->N, i));
    if (triangle != passed.ray->own && passed.grid && isOutside(*passed.grid, t)) continue;
    uint32_t closed = 0;
    const bool own = triangle == passed.ray->own,
               there = !own && pieceAt(*passed.facets, passed.ray->at(t), triangle, &closed);
    if (closed != 0 && passed.panes != nullptr) passed.panes->push_back({t, closed});
    if (!there || (passed.hiddenBacks && atHiddenBack(*passed.facets, *passed.ray, triangle, normal)))
      arguments->valid[i] = 0;
  }
}

class EmbreeTrace : public HostTrace {
 public:
  EmbreeTrace(Context& context, const FacetList& list, uint64_t memory)
      : facets_(oracleFacets(context, list)),
        lattices_(list.outer.lattices),
        scene_(positions(facets_), corners(facets_), std::min(memory, free(context.device.memory()))) {}

  void rows(const MatrixParams& params, uint32_t firstRow, uint32_t rows, std::span<uint32_t> hits, uint32_t threads,
            bool sky, uint32_t tintShift) const override {
    IRAD_CHECK_OP(hits.size(), >=, uint64_t{rows} * params.rays);
    const auto trace = [&](size_t r) {
      row(params, firstRow + static_cast<uint32_t>(r), sky, tintShift, hits.subspan(r * params.rays, params.rays));
    };
    parallelFor(rows, trace, threads, kBlock);
  }

  void emitters(const EmitterSamples& from, std::span<glm::vec4> light, uint32_t threads) const override {
    IRAD_CHECK_OP(light.size(), >=, facets_.voxel.size());
    IRAD_CHECK_OP(from.exitance.size(), ==, facets_.voxel.size());
    const EmitterSurfels to(*this, from.table);
    const auto gather = [&](size_t f) { light[f] = lightOf(from, to, static_cast<uint32_t>(f)); };
    parallelFor(facets_.voxel.size(), gather, threads, kBlock);
  }

  void direct(std::span<const GpuLight> lights, std::span<glm::vec4> light, uint32_t threads) const override {
    IRAD_CHECK_OP(light.size(), >=, facets_.voxel.size());
    const auto gather = [&](size_t f) { light[f] = {directOf(lights, static_cast<uint32_t>(f)), 0}; };
    parallelFor(facets_.voxel.size(), gather, threads, kBlock);
  }

  void rays(std::span<const HostRay> rays, std::span<uint32_t> hits) const override {
    IRAD_CHECK_OP(hits.size(), >=, rays.size());
    for (size_t first = 0; first < rays.size(); first += kPacket)
      trace(rays.subspan(first, std::min<size_t>(kPacket, rays.size() - first)), &hits[first], Closed());
  }

 private:
  /// The channels that panes have kept off, as bits, of each ray of a packet.
  using Closed = std::array<uint32_t, kPacket>;
  using FacetSurfels = std::array<SurfelPoint, FACET_SURFELS>;

  static uint64_t free(const Allocator& memory) { return memory.budget() - std::min(memory.budget(), memory.used()); }
  static std::vector<glm::vec3> positions(const oracle::Facets& facets) {
    return {facets.corners.begin(), facets.corners.end()};
  }
  static std::vector<uint32_t> corners(const oracle::Facets& facets) {
    std::vector<uint32_t> indices(facets.corners.size());
    // Triangles that repeat others become points, which rays do not meet.
    for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = facets.repeats(i / 3) ? i / 3 * 3 : i;
    return indices;
  }

  void row(const MatrixParams& params, uint32_t facet, bool sky, uint32_t tintShift, std::span<uint32_t> hits) const {
    const uvec4 shifts = rayShifts(facets_.voxel[facet], params.seed, params.jitter);
    const FacetSurfels from = liftedSurfels(facet);
    const uint32_t rays = oracle::raysOf(facets_, facet, params);
    std::fill(hits.begin() + rays, hits.end(), TRACE_NOT_CAST);
    for (uint32_t first = 0; first < rays; first += kPacket) {
      std::array<HostRay, kPacket> packet;
      const std::span<HostRay> some(packet.data(), std::min(kPacket, rays - first));
      for (uint32_t k = first; HostRay & ray : some) {
        const SurfelPoint& start = from[raySurfel(k, shifts)];
        ray = {start.position, rayDirection(start.facing, k++, rays, shifts), start.triangle};
      }
      Closed closed{};
      trace(some, &hits[first], closed);
      for (size_t i = 0; i < some.size(); ++i) {
        uint32_t& hit = hits[first + i];
        if (sky && hit == TRACE_ESCAPED) hit = metSky(some[i].direction);
        if (!sky && isSky(hit)) hit = TRACE_ESCAPED;
        if (closed[i] == 0 || tintShift == 0) continue;
        if (hit <= TRACE_LAST_FACET)
          hit |= closed[i] << tintShift;
        else if (isSky(hit))
          hit |= closed[i] << TINT_SHIFT_SKY;
      }
    }
  }

  /// Rays towards light, which wait until a packet is full. `arrives` is called with what each brings, less what panes
  /// keep off, if nothing is in its way: in turn.
  template <class Arrives>
  class LightRays {
   public:
    LightRays(const EmbreeTrace& trace, Arrives arrives) : trace_(trace), arrives_(std::move(arrives)) {}
    /// `reach`: how far away the light is, voxels.
    void add(const HostRay& ray, float reach, const glm::vec3& brings) {
      rays_[waiting_] = ray;
      before_[waiting_] = shortOf(reach);
      brings_[waiting_++] = brings;
      if (waiting_ == kPacket) send();
    }
    void send() {
      if (waiting_ == 0) return;
      Closed closed{};
      const uint32_t open = trace_.reaching(std::span(rays_).first(waiting_), before_.data(), closed);
      for (uint32_t i = 0; i < waiting_; ++i)
        if ((open >> i & 1) != 0) arrives_(brings_[i] * openChannels(closed[i]));
      waiting_ = 0;
    }

   private:
    const EmbreeTrace& trace_;
    Arrives arrives_;
    std::array<HostRay, kPacket> rays_;
    std::array<float, kPacket> before_;
    std::array<glm::vec3, kPacket> brings_;
    uint32_t waiting_ = 0;
  };

  /// gi/gather_surfels.comp.
  glm::vec3 directOf(std::span<const GpuLight> lights, uint32_t facet) const {
    const glm::uvec2 shift(hashUint(facet), hashUint(~facet));
    const float edge = facets_.grid.edge;
    glm::vec3 sum(0);
    LightRays rays(*this, [&](const glm::vec3& brought) { sum += brought; });
    for (uint32_t surfel = 0; surfel < FACET_SURFELS; ++surfel) {
      const SurfelPoint from = liftedSurfel(facet, surfel);
      const glm::vec3 position = facets_.grid.origin + edge * from.position;
      const auto send = [&](const glm::vec3& direction, float reach, const glm::vec3& brings) {
        rays.add({from.position, direction, from.triangle}, inVoxels(reach, edge), brings);
      };
      for (const GpuLight& light : lights) {
        const glm::vec3 irradiance = lightIrradiance(light, position, from.facing);
        if (irradiance == glm::vec3(0)) continue;
        if (!hasSize(light)) {
          send(lightDirection(light, position), lightReach(light, position), irradiance);
          continue;
        }
        const uint32_t points = pointsForSurfels(light);
        for (uint32_t k = surfel; k < points; k += FACET_SURFELS) {
          float reach;
          const glm::vec3 direction = lightPoint(light, position, k, points, shift, reach);
          if (glm::dot(direction, from.facing) <= 0) continue;
          send(direction, reach, irradiance * (float{FACET_SURFELS} / static_cast<float>(points)));
        }
      }
    }
    rays.send();
    return sum / float{FACET_SURFELS};
  }

  /// Of the facets of a table: each is drawn by thousands of others.
  class EmitterSurfels {
   public:
    EmitterSurfels(const EmbreeTrace& trace, std::span<const Emitter> table)
        : place_(trace.facets_.voxel.size(), kNone) {
      for (const Emitter& e : table)
        for (const uint32_t facet : {e.facet, e.other}) {
          if (place_[facet] != kNone) continue;
          place_[facet] = static_cast<uint32_t>(surfels_.size());
          surfels_.push_back(trace.liftedSurfels(facet));
        }
    }
    const SurfelPoint& at(uint32_t facet, uint32_t surfel) const { return surfels_[place_[facet]][surfel]; }

   private:
    static constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> place_;  ///< of facets among these
    std::vector<FacetSurfels> surfels_;
  };

  /// gi/sample_emitters.comp.
  glm::vec4 lightOf(const EmitterSamples& emitters, const EmitterSurfels& ofEmitters, uint32_t facet) const {
    const uint32_t voxel = facets_.voxel[facet];
    const uvec4 shifts = rayShifts(voxel, emitters.seed ^ EMITTERS_SEED, 1);
    const FacetSurfels surfels = liftedSurfels(facet);
    const float each = 1.0f / static_cast<float>(emitters.samples);
    glm::vec3 sum(0);
    float squares = 0;
    LightRays rays(*this, [&](const glm::vec3& brought) {
      sum += brought;
      squares += glm::dot(brought, brought);
    });
    for (uint32_t k = 0; k < emitters.samples; ++k) {
      float x;
      const uint32_t emitter =
          emitterFacet(emitters.table, shifts.x + (2 * k + 1) * (0x80000000u / emitters.samples), x);
      if (areNear(unpackVoxel(voxel), unpackVoxel(facets_.voxel[emitter]))) continue;
      const SurfelPoint& to = ofEmitters.at(emitter, static_cast<uint32_t>(x * static_cast<float>(FACET_SURFELS)));
      const SurfelPoint& start = surfels[raySurfel(k, shifts)];
      const glm::vec3 way = to.position - start.position;
      const float reach = glm::length(way);
      const glm::vec3 direction = way / reach;
      const float cosines =
          std::max(glm::dot(start.facing, direction), 0.0f) * std::max(-glm::dot(to.facing, direction), 0.0f);
      if (cosines == 0) continue;
      const glm::vec3 exitance = emitters.exitance[emitter];
      rays.add({start.position, direction, start.triangle}, reach,
               exitance * (cosines * emitters.power / (luminance(exitance) * IRAD_PI * reach * reach)));
    }
    rays.send();
    const glm::vec3 mean = sum * each;
    return {mean, each * std::max(squares * each - glm::dot(mean, mean), 0.0f)};
  }

  /// gi/emitter_point.glsl.
  static uint32_t emitterFacet(std::span<const Emitter> table, uint32_t u, float& rest) {
    const uint64_t place = uint64_t{u} * table.size();
    rest = unitFloat(static_cast<uint32_t>(place));
    return drawnFacet(table[place >> 32], rest);
  }

  /// Of a packet those, as bits, that meet nothing before `before`, but for panes.
  uint32_t reaching(std::span<const HostRay> rays, const float* before, Closed& closed) const {
    Down down;
    RTCRay8 packet{};
    for (size_t i = 0; i < rays.size(); ++i) down.put(packet, i, rays[i], before[i]);
    rtcOccluded8(down.valid, scene_.handle(), &down.context, &packet);
    uint32_t open = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      if (packet.tfar[i] >= 0 || passes(rays[i], before[i], closed[i])) open |= 1u << i;
    }
    return open;
  }
  /// Whether a ray that comes upon something passes through it.
  bool passes(const HostRay& ray, float before, uint32_t& closed) const {
    std::vector<PassedThrough::Pane> panes;
    PassedThrough passed = through(ray, /*hiddenBacks=*/false, &panes);
    RTCRay sent = EmbreeScene::ray(ray.origin, ray.direction, 0, before);
    rtcOccluded1(scene_.handle(), &passed.context, &sent);
    if (sent.tfar < 0) return false;
    for (const PassedThrough::Pane& pane : panes) closed |= pane.closed;
    return closed != TINT_NONE_LEFT;
  }

  FacetSurfels liftedSurfels(uint32_t facet) const {
    FacetSurfels all;
    for (uint32_t i = 0; i < FACET_SURFELS; ++i) all[i] = liftedSurfel(facet, i);
    return all;
  }
  SurfelPoint liftedSurfel(uint32_t facet, uint32_t i) const {
    const Surfel& s = facets_.surfels[FACET_SURFELS * size_t{facet} + i];
    SurfelPoint p = surfelOn(triangleAt(facets_, s.triangle & ~SURFEL_BACK), s, unpackVoxel(facets_.voxel[facet]));
    p.position = liftedOff(p);
    return p;
  }
  /// gi/trace_triangles.glsl.
  glm::vec3 liftedOff(const SurfelPoint& p) const {
    if (lattices_.empty()) return liftedStart(p.position, p.facing);
    return liftedFar(p.position, p.facing, triangleAt(facets_, p.triangle));
  }

  /// What goes down the tree beside a packet, and which of its rays there are.
  struct Down {
    Down() { rtcInitIntersectContext(&context); }
    void put(RTCRay8& packet, size_t i, const HostRay& ray, float far) {
      valid[i] = -1;
      packet.org_x[i] = ray.origin.x;
      packet.org_y[i] = ray.origin.y;
      packet.org_z[i] = ray.origin.z;
      packet.dir_x[i] = ray.direction.x;
      packet.dir_y[i] = ray.direction.y;
      packet.dir_z[i] = ray.direction.z;
      packet.tfar[i] = far;
      packet.mask[i] = ~0u;
    }
    RTCIntersectContext context;
    alignas(32) int valid[kPacket] = {};
  };
  void trace(std::span<const HostRay> rays, uint32_t* hits, Closed&& closed) const { trace(rays, hits, closed); }
  void trace(std::span<const HostRay> rays, uint32_t* hits, Closed& closed) const {
    Down down;
    RTCRayHit8 packet{};
    for (size_t i = 0; i < rays.size(); ++i) {
      down.put(packet.ray, i, rays[i], std::numeric_limits<float>::infinity());
      packet.hit.geomID[i] = packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(down.valid, scene_.handle(), &down.context, &packet);
    for (size_t i = 0; i < rays.size(); ++i) {
      const glm::vec3 normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
      const std::optional<uint32_t> met = facetMet(rays[i], packet.hit.primID[i], packet.ray.tfar[i], normal);
      hits[i] = met ? *met : traceThrough(rays[i], closed[i]);
    }
  }

  PassedThrough through(const HostRay& ray, bool hiddenBacks, std::vector<PassedThrough::Pane>* panes) const {
    PassedThrough passed{.context = {},
                         .facets = &facets_,
                         .ray = &ray,
                         .hiddenBacks = hiddenBacks,
                         .grid = gridOf(ray),
                         .panes = panes};
    rtcInitIntersectContext(&passed.context);
    passed.context.filter = passThrough;
    return passed;
  }

  /// A ray that has come upon something to pass through, as few do.
  uint32_t traceThrough(const HostRay& ray, uint32_t& closed) const {
    std::vector<PassedThrough::Pane> panes;
    float t = 0;
    const uint32_t met =
        traceBetween(ray, 0, std::numeric_limits<float>::infinity(), /*hiddenBacks=*/false, &panes, &t);
    for (const PassedThrough::Pane& pane : panes)
      if (pane.t < t) closed |= pane.closed;
    return closed == TINT_NONE_LEFT ? TRACE_BLOCKED : met;
  }

  /// `t`: where.
  uint32_t traceBetween(const HostRay& ray, float near, float far, bool hiddenBacks,
                        std::vector<PassedThrough::Pane>* panes = nullptr, float* t = nullptr) const {
    PassedThrough passed = through(ray, hiddenBacks, panes);
    RTCRayHit met{.ray = EmbreeScene::ray(ray.origin, ray.direction, near, far), .hit = {}};
    met.hit.geomID = met.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.handle(), &passed.context, &met);
    if (t != nullptr) *t = met.ray.tfar;
    return facetMet(ray, met.hit.primID, met.ray.tfar, {met.hit.Ng_x, met.hit.Ng_y, met.hit.Ng_z})
        .value_or(TRACE_INVALID);
  }

  /// The facet, or TRACE_*, where a ray meets a triangle; none where it passes through. `normal`: of the front.
  std::optional<uint32_t> facetMet(const HostRay& ray, uint32_t triangle, float t, const glm::vec3& normal) const {
    if (triangle == RTC_INVALID_GEOMETRY_ID) return TRACE_ESCAPED;
    if (triangle == ray.own) return std::nullopt;
    const glm::vec3 at = ray.at(t);
    if (const std::optional<glm::vec2> grid = gridOf(ray); grid && isOutside(*grid, t))
      return pointMet(ray, triangle, at, normal);
    const std::optional<Piece> piece = pieceAt(facets_, at, triangle);
    if (!piece) return std::nullopt;
    if (atHiddenBack(facets_, ray, triangle, normal)) {
      // What shows a side there wins.
      const float delay = backDelay(facets_.grid.dims, glm::dot(glm::normalize(normal), ray.direction));
      const uint32_t shown = traceBetween(ray, std::max(0.0f, t - delay), t + delay, /*hiddenBacks=*/true);
      if (shown != TRACE_ESCAPED) return shown;
    }
    const uint32_t found = classAt(facets_, piece->index, glm::dot(normal, ray.direction) > 0, at);
    if (found < PIECE_UNKNOWN) return piece->firstFacet + found;
    return found == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID;
  }

  /// Where nothing lies outside there is no need for it.
  std::optional<glm::vec2> gridOf(const HostRay& ray) const {
    return lattices_.empty() ? std::nullopt : std::optional(ofGrid(facets_, ray));
  }

  /// The point outside the grid that stands for what a ray has met there (outerPoint, shaders/gi/trace_outer.glsl).
  uint32_t pointMet(const HostRay& ray, uint32_t triangle, const glm::vec3& at, const glm::vec3& normal) const {
    if (atHiddenBack(facets_, ray, triangle, normal)) return TRACE_BLOCKED;
    const OuterLattice lattice = lattices_.at(triangle);
    // By a rounding: it ends at the grid's face, half a voxel outside of its region.
    if (lattice.first == NO_LATTICE) return TRACE_INVALID;
    const Triangle t = triangleAt(facets_, triangle);
    const uint32_t point = lattice.first + nearestLattice(lattice.edges, barycentricOf(t.a, t.b, t.c, at));
    return metOuter(glm::dot(normal, ray.direction) > 0 ? point + latticePoints(lattice.edges) : point);
  }

  oracle::Facets facets_;
  std::vector<OuterLattice> lattices_;
  EmbreeScene scene_;
};

}  // namespace

bool canTraceOnHost() {
  return true;
}

std::unique_ptr<HostTrace> makeHostTrace(Context& context, const FacetList& facets, uint64_t memory) {
  return std::make_unique<EmbreeTrace>(context, facets, memory);
}

}  // namespace irad
