#include "gi/surface_on_host.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "renderer/base/parallel.h"
#include "shaders/gi/class_point.h"
#include "shaders/gi/facet_mean.h"
#include "shaders/gi/facet_surfels.h"
#include "shaders/gi/links.h"
#include "shaders/gi/list_pieces.h"
#include "shaders/gi/piece_points.h"
#include "shaders/gi/piece_shape.h"
#include "shaders/gi/piece_sides.h"
#include "shaders/gi/piece_size.h"

namespace irad {
namespace {

/// Voxels, pieces or facets that a thread takes at once.
constexpr size_t kVoxelBlock = 64;

/// Marks all but the largest pieces of a voxel, of which at most MOST_LARGE are not.
void markSmall(Vec4Array corners, const glm::vec3& cell, std::span<uint32_t> pieces) {
  std::array<uint32_t, PIECE_SIZES> ofSize{};
  for (const uint32_t piece : pieces) ++ofSize[pieceSize(corners, cell, piece)];
  uint32_t large = 0, count = 0;
  while (large < PIECE_SIZES && count + ofSize[large] <= MOST_LARGE) count += ofSize[large++];
  for (uint32_t& piece : pieces)
    if (pieceSize(corners, cell, piece) >= large) piece |= PIECE_SMALL;
}

/// The classes of one voxel's points.
class VoxelClasses {
 public:
  VoxelClasses(const ClassPointsPush& push, const SurfaceArrays& surface, uint32_t voxel)
      : push_(push),
        surface_(surface),
        voxel_(voxel),
        pieces_(piecesOfSolid(push, surface, voxel)),
        first_(push.firstPoint.at[pieces_.first]),
        end_(push.firstPoint.at[pieces_.end]),
        stride_(isCrowd() ? (end_ - first_ + MOST_COMPARED - 1) / MOST_COMPARED : 1) {}

  void find() {
    findLeaders();
    // Every voxel has a facet: its pieces end where the next one's begin.
    if (leaders_ == 0) push_.classes.at[first_] = CLASS_LEADER;
    push_.facets.at[voxel_] = std::max(leaders_, 1u);
    push_.wide.at[voxel_] = pieces_.end - pieces_.first > MOST_NARROW ? std::max(leaders_, 1u) : 0u;
    if (stride_ > 1) joinNeighbours();
    if (leaders_ > LAST_CLASS && pieces_.endLarge != pieces_.end) joinAlike();
  }

 private:
  bool isCrowd() const { return end_ - first_ > CROWD; }
  uint32_t& classOf(uint32_t i) const { return push_.classes.at[i]; }
  ClassPoint point(uint32_t i) const { return classPoint(push_, surface_, i); }
  glm::vec3 facing(uint32_t i) const { return point(i).point.at.facing; }

  /// The first point from `from` on that belongs to no class yet and has the area to lead one; the end.
  uint32_t nextLeader(uint32_t from, float least) const {
    for (; from < end_; from += stride_)
      if (classOf(from) == NO_CLASS && push_.area.at[push_.points.at[from].side & ~SURFEL_BACK] >= least) return from;
    return end_;
  }

  void findLeaders() {
    float least = LEAST_FACET;
    uint32_t from = first_;
    while (leaders_ <= LAST_CLASS) {
      from = nextLeader(from, least);
      if (from >= end_) {
        // Where nothing is large enough, what there is makes facets: one, or those of a crowd.
        if (leaders_ > 0 || least == 0) return;
        least = 0;
        from = first_;
        continue;
      }
      const SidePoint leader = point(from).point;
      for (uint32_t i = first_; i < end_; i += stride_)
        if (classOf(i) == NO_CLASS && i != from && sameSide(pieces_, leader, point(i).point)) classOf(i) = leaders_;
      classOf(from) = leaders_ | CLASS_LEADER;
      leader_[leaders_++] = from;
      if (least == 0 && !isCrowd()) return;
    }
  }

  /// Neighbours in the list are neighbours in the mesh: those not compared go with the next one that faces their way.
  void joinNeighbours() const {
    for (uint32_t i = first_; i < end_; ++i) {
      if ((i - first_) % stride_ == 0 || classOf(i) != NO_CLASS) continue;
      const glm::vec3 facing_ = facing(i);
      const uint32_t compared = i - (i - first_) % stride_;
      for (uint32_t k = 0; k < 8; ++k) {
        const uint32_t near = compared + (k % 2 == 0 ? -(k / 2) * stride_ : (k / 2 + 1) * stride_);
        if (near < first_ || near >= end_) continue;
        const uint32_t found = classOf(near);
        if (found == NO_CLASS || isOfPart(found) || !facesAlike(facing(near), facing_)) continue;
        classOf(i) = found & ~CLASS_LEADER;
        break;
      }
    }
  }

  /// What is left of a voxel that would have more facets than there may be, and of which not all pieces are looked at,
  /// goes with those that face its way most.
  void joinAlike() const {
    for (uint32_t i = first_; i < end_; ++i) {
      if (classOf(i) != NO_CLASS) continue;
      const glm::vec3 facing_ = facing(i);
      float most = 0;
      for (uint32_t k = 0; k < leaders_; ++k) {
        const float alike = preciseDot(facing(leader_[k]), facing_);
        if (alike <= most) continue;
        most = alike;
        classOf(i) = k;
      }
    }
  }

  const ClassPointsPush& push_;
  const SurfaceArrays& surface_;
  const uint32_t voxel_;
  const VoxelPieces pieces_;
  const uint32_t first_, end_;  ///< points
  const uint32_t stride_;       ///< of the points that are compared
  uint32_t leaders_ = 0;
  std::array<uint32_t, LAST_CLASS + 1> leader_;
};

/// The links of one facet.
class FacetLinker {
 public:
  FacetLinker(const LinkFacetsPush& push, const SurfaceArrays& surface, uint32_t facet)
      : push_(push),
        surface_(surface),
        facet_(facet),
        side_(surfelAt(surface, surfelsOf(surface, facet), FACET_SURFELS / 2).triangle) {
    const glm::ivec3 voxel(unpackVoxel(push.voxel.at[facet]));
    for (uint32_t place = 0; place < 27; ++place) {
      entries_[place] = entryOf(push.reverse, push.dims, voxel + stepTo(place));
      whole_[place] = wholePiece(surface, entries_[place], side_);
    }
  }

  void find() const {
    uint32_t mask = 0;
    uint8_t* found = push_.found.at + size_t{FACET_LINKS} * facet_;
    std::fill_n(found, FACET_LINKS, static_cast<uint8_t>(NO_LINK));
    for (uint32_t place = 0; place < 27; ++place) {
      const uint32_t link = place == OWN_VOXEL ? inVoxel() : linkTo(place);
      found[place] = static_cast<uint8_t>(link);
      if (place != OWN_VOXEL && link != NO_LINK) mask |= 1u << place;
    }
    push_.masks.at[facet_] = mask;
    push_.counts.at[facet_] = static_cast<uint32_t>(std::popcount(mask));
  }

 private:
  uint32_t inVoxel() const { return facet_ - firstFacet(entries_[OWN_VOXEL]); }

  bool goesOn(const glm::ivec3& step) const {
    for (uint32_t corner = 0; corner < 8; ++corner)
      if (whole_[blockPlace(corner, step)] == NO_LINK) return false;
    return true;
  }

  uint32_t linkTo(uint32_t place) const {
    const uint32_t entry = entries_[place];
    if (entry == NO_FACET) return NO_LINK;
    const glm::ivec3 step = stepTo(place);
    if (whole_[place] < NO_LINK && whole_[OWN_VOXEL] == inVoxel() && goesOn(step)) return whole_[place];
    const uint32_t own = nearestOf(facet_, borderTo(push_.voxel.at[facet_], step)).surfel;
    uint32_t link = NO_LINK;
    float best = 1e30f;
    for (uint32_t k = 0; k < facetsOf(entry); ++k) {
      const uint32_t other = firstFacet(entry) + k;
      if (!facesAlike(push_.facings.at[facet_], push_.facings.at[other])) continue;
      const Nearest nearest = nearestOf(other, glm::vec3(pointOf(facet_, own)));
      if (nearest.distance2 >= best) continue;
      const SidePoint from = sidePoint(facet_, own), to = sidePoint(other, nearest.surfel);
      if (!continues(surface_, push_.reverse, push_.dims, from, to)) continue;
      best = nearest.distance2;
      link = k;
    }
    return link;
  }

  struct Nearest {
    uint32_t surfel;
    float distance2;
  };
  /// The surfel of a facet that is nearest to a point.
  Nearest nearestOf(uint32_t facet, const glm::vec3& point) const {
    Nearest nearest{0, 1e30f};
    for (uint32_t k = 0; k < FACET_SURFELS; ++k) {
      const glm::vec3 d = glm::vec3(pointOf(facet, k)) - point;
      if (const float distance2 = glm::dot(d, d); distance2 < nearest.distance2) nearest = {k, distance2};
    }
    return nearest;
  }
  const glm::vec4& pointOf(uint32_t facet, uint32_t k) const {
    return push_.points.at[FACET_SURFELS * size_t{facet} + k];
  }
  SidePoint sidePoint(uint32_t facet, uint32_t k) const { return {surfelOf(surface_, facet, k), pointOf(facet, k).w}; }

  const LinkFacetsPush& push_;
  const SurfaceArrays& surface_;
  const uint32_t facet_, side_;  ///< side_: triangle | SURFEL_BACK of its middle surfel
  std::array<uint32_t, 27> entries_, whole_;
};

}  // namespace

void listPiecesOnHost(const ListPiecesPush& push) {
  const glm::uvec3 dims = push.grid.at[0].dims;
  const auto list = [&](size_t i) {
    const uint32_t triangle = push.firstTriangle + static_cast<uint32_t>(i);
    if (firstInPlace(push.corners, triangle) != triangle) return;
    const VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
    glm::ivec3 lo, hi;
    if (degenerate(t) || !cellBounds(t, dims, lo, hi)) return;
    lo = dominantLast(lo, t.axis);
    hi = dominantLast(hi, t.axis);
    listPieces(push, t, triangle, dims, lo, hi, glm::ivec2(lo), glm::ivec2(hi));
  };
  parallelFor(push.endTriangle - push.firstTriangle, list, /*threads=*/0, kVoxelBlock);
}

void sortPiecesOnHost(const SortPiecesPush& push) {
  const auto sort = [&](size_t voxel) {
    const uint32_t first = push.firstPiece.at[voxel], count = push.firstPiece.at[voxel + 1] - first;
    const std::span<uint32_t> pieces(push.pieces.at + first, count);
    if (count > MOST_COUNTED)
      for (uint32_t& piece : pieces) piece |= PIECE_SMALL;
    else if (count > MOST_LARGE)
      markSmall(push.corners, glm::vec3(unpackVoxel(push.solid.at[voxel])), pieces);
    std::ranges::sort(pieces);
    std::ranges::copy(pieces, push.sorted.at + first);
    std::fill_n(push.pieceVoxel.at + first, count, static_cast<uint32_t>(voxel));
  };
  parallelFor(push.count, sort, /*threads=*/0, kVoxelBlock);
}

void shapePiecesOnHost(const PieceShapePush& push) {
  const auto shape = [&](size_t piece) { shapePiece(push, static_cast<uint32_t>(piece)); };
  parallelFor(push.count, shape, /*threads=*/0, kVoxelBlock);
}

void findPointsOnHost(const PiecePointsPush& push, const SurfaceArrays& surface) {
  const auto find = [&](size_t piece) { findPoints(push, surface, static_cast<uint32_t>(piece)); };
  parallelFor(push.count, find, /*threads=*/0, kVoxelBlock);
}

void classPointsOnHost(const ClassPointsPush& push, const SurfaceArrays& surface) {
  const auto find = [&](size_t voxel) { VoxelClasses(push, surface, static_cast<uint32_t>(voxel)).find(); };
  parallelFor(push.count, find, /*threads=*/0, kVoxelBlock);
}

void findSidesOnHost(const PieceSidesPush& push, const SurfaceArrays& surface) {
  const auto find = [&](size_t piece) { findSides(push, surface, static_cast<uint32_t>(piece)); };
  parallelFor(push.count, find, /*threads=*/0, kVoxelBlock);
}

void placeSurfelsOnHost(const FacetSurfelsPush& push, const SurfaceArrays& surface) {
  const auto place = [&](size_t facet) { placeSurfels(push, surface, static_cast<uint32_t>(facet)); };
  parallelFor(push.count, place, /*threads=*/0, kVoxelBlock);
}

void linkFacetsOnHost(const LinkFacetsPush& push, const SurfaceArrays& surface) {
  const auto place = [&](size_t i) {
    const SurfelPoint p = surfelOf(surface, static_cast<uint32_t>(i / FACET_SURFELS), i % FACET_SURFELS);
    push.points.at[i] = glm::vec4(p.position, liftOf(surface, push.reverse, push.dims, p));
  };
  parallelFor(size_t{FACET_SURFELS} * push.count, place, /*threads=*/0, kVoxelBlock * FACET_SURFELS);
  const auto find = [&](size_t facet) { FacetLinker(push, surface, static_cast<uint32_t>(facet)).find(); };
  parallelFor(push.count, find, /*threads=*/0, kVoxelBlock);
}

void meanFacetsOnHost(const FacetMeanPush& push, const SurfaceArrays& surface) {
  const auto mean = [&](size_t facet) { meanFacet(push, surface, static_cast<uint32_t>(facet)); };
  parallelFor(push.count, mean, /*threads=*/0, kVoxelBlock);
}

}  // namespace irad
