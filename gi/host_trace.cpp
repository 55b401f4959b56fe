#include "gi/host_trace.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "gi/embree_scene.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/oracle/rays.h"
#include "renderer/base/error.h"
#include "renderer/frame/context.h"
#include "renderer/resources.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

/// Rows that a thread takes at once.
constexpr uint32_t kBlock = 16;

Triangle triangleAt(const oracle::Facets& facets, uint32_t triangle) {
  const glm::vec4* corner = &facets.corners[3 * size_t{triangle}];
  return {glm::vec3(corner[0]), glm::vec3(corner[1]), glm::vec3(corner[2])};
}

/// A triangle's part in one voxel.
struct Piece {
  uint32_t index, firstFacet;  ///< firstFacet: of the voxel
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
  const auto found = std::lower_bound(begin, end, triangle);
  if (found == end || *found != triangle) return std::nullopt;
  return Piece{static_cast<uint32_t>(found - facets.pieces.begin()), facet};
}

/// The triangle's piece at one of its points: in the voxel that holds it or, where rounding has put it into another,
/// the next one. None: a mask has cut a hole there, or the triangle is too thin to be listed.
std::optional<Piece> pieceAt(const oracle::Facets& facets, const glm::vec3& at, uint32_t triangle) {
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

/// gi/piece_cuts.glsl.
uint32_t classAt(const oracle::Facets& facets, uint32_t piece, bool back, const glm::vec3& at) {
  const uint32_t sides = facets.sides[piece], shift = back ? 8 : 0;
  if ((sides & PIECE_CUT) == 0) return (sides >> shift) & 0xFFu;
  const uint32_t* cuts = &facets.cuts[sides & ~PIECE_CUT];
  const uint32_t count = *cuts++;
  uint32_t part = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Triangle t = triangleAt(facets, cuts[i]);
    const float side = glm::dot(facingOf(t, false), at - t.a);
    if (std::abs(side) < CUT_WIDTH) return PIECE_UNKNOWN;
    part |= side > 0 ? 1u << i : 0u;
  }
  for (const uint32_t point : std::span(cuts + count, CUT_POINTS)) {
    const uint32_t found = (point >> shift) & 0xFFu;
    if (point >> 16 == part && found != PIECE_UNKNOWN) return found;
  }
  return PIECE_UNKNOWN;
}

/// What a ray passes through: the triangle that it leaves, and triangles where they have no piece.
struct PassedThrough {
  RTCIntersectContext context;  // first: Embree hands back its address
  const oracle::Facets* facets;
  uint32_t from;
};

glm::vec3 along(const RTCRay& ray, float t) {
  return glm::vec3(ray.org_x, ray.org_y, ray.org_z) + glm::vec3(ray.dir_x, ray.dir_y, ray.dir_z) * t;
}

void passThrough(const RTCFilterFunctionNArguments* arguments) {
  const auto& passed = *reinterpret_cast<const PassedThrough*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const RTCRay ray = rtcGetRayFromRayN(arguments->ray, arguments->N, i);
    if (triangle == passed.from || !pieceAt(*passed.facets, along(ray, ray.tfar), triangle)) arguments->valid[i] = 0;
  }
}

class EmbreeTrace : public HostTrace {
 public:
  EmbreeTrace(Context& context, const FacetList& list)
      : facets_(oracleFacets(context, list)),
        scene_(positions(facets_), corners(facets_), free(context.device.memory())) {}

  void rows(const MatrixParams& params, uint32_t firstRow, uint32_t rows, std::span<uint32_t> hits,
            uint32_t threads) const override {
    IRAD_CHECK_OP(hits.size(), >=, uint64_t{rows} * params.rays);
    std::atomic<uint32_t> next = 0;
    const auto work = [&] {
      for (uint32_t block; (block = next++) <= (rows - 1) / kBlock;)
        for (uint32_t r = block * kBlock; r < std::min(rows, (block + 1) * kBlock); ++r)
          row(params, firstRow + r, hits.subspan(uint64_t{r} * params.rays, params.rays));
    };
    if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (uint32_t t = 1; t < threads; ++t) others.emplace_back(work);
    work();
  }

 private:
  static uint64_t free(const Allocator& memory) { return memory.budget() - std::min(memory.budget(), memory.used()); }
  static std::vector<glm::vec3> positions(const oracle::Facets& facets) {
    return {facets.corners.begin(), facets.corners.end()};
  }
  static std::vector<uint32_t> corners(const oracle::Facets& facets) {
    std::vector<uint32_t> indices(facets.corners.size());
    for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
    return indices;
  }

  void row(const MatrixParams& params, uint32_t facet, std::span<uint32_t> hits) const {
    const uvec4 shifts = rayShifts(facets_.voxel[facet], params.seed, params.jitter);
    std::array<SurfelPoint, FACET_SURFELS> from;
    for (uint32_t i = 0; i < FACET_SURFELS; ++i) {
      const Surfel& s = facets_.surfels[FACET_SURFELS * size_t{facet} + i];
      from[i] = surfelOn(triangleAt(facets_, s.triangle & ~SURFEL_BACK), s);
      from[i].position = liftedStart(from[i].position, from[i].facing);
    }
    for (uint32_t k = 0; k < params.rays; ++k) {
      const SurfelPoint& start = from[raySurfel(k, shifts)];
      hits[k] = trace(start.position, rayDirection(start.facing, k, params.rays, shifts), start.triangle);
    }
  }

  uint32_t trace(const glm::vec3& origin, const glm::vec3& direction, uint32_t own) const {
    PassedThrough passed{.context = {}, .facets = &facets_, .from = own};
    rtcInitIntersectContext(&passed.context);
    // Few rays come upon something to pass through: they are traced again.
    for (const RTCFilterFunctionN filter : {RTCFilterFunctionN{}, RTCFilterFunctionN{passThrough}}) {
      passed.context.filter = filter;
      RTCRayHit hit{.ray = EmbreeScene::ray(origin, direction, 0, std::numeric_limits<float>::infinity()), .hit = {}};
      hit.hit.geomID = hit.hit.primID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_.handle(), &passed.context, &hit);
      if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return TRACE_ESCAPED;
      if (hit.hit.primID == own) continue;
      const glm::vec3 at = along(hit.ray, hit.ray.tfar);
      const std::optional<Piece> piece = pieceAt(facets_, at, hit.hit.primID);
      if (!piece) continue;
      const bool back = glm::dot(glm::vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z), direction) > 0;
      const uint32_t found = classAt(facets_, piece->index, back, at);
      if (found < PIECE_UNKNOWN) return piece->firstFacet + found;
      return found == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID;
    }
    return TRACE_INVALID;
  }

  oracle::Facets facets_;
  EmbreeScene scene_;
};

}  // namespace

bool canTraceOnHost() {
  return true;
}

std::unique_ptr<HostTrace> makeHostTrace(Context& context, const FacetList& facets) {
  return std::make_unique<EmbreeTrace>(context, facets);
}

}  // namespace irad
