// Steps of listing a surface that kernels take or, in their place, the host (gi/surface_on_host.h), and what they pass
// on.
#pragma once

#include "gi/facets.h"
#include "gi/subsystems.h"
#include "shaders/shared/surface.h"

namespace irad {

inline constexpr const char* kListStage = "GI CompactList";

inline Buffer facetWords(const Device& device, const char* name, uint64_t count) {
  return Buffer(device, name, Subsystem::Facets, 4 * count);
}

/// Which triangles have a piece in which voxel.
struct SurfacePieces {
  uint32_t solid = 0, count = 0;  ///< voxels; pieces
  Buffer voxel;                   ///< packVoxel of each solid voxel, in Morton order
  Buffer first;                   ///< of each solid voxel; and the end
  Buffer triangle;                ///< per piece, ascending within a voxel
  Buffer pieceVoxel;              ///< which solid voxel
  Buffer area;                    ///< float, voxel faces
  Buffer facings;                 ///< the triangles' unit normals, until points have their facets
  Buffer boxes, groups;           ///< packBox; and around groups of them
  Buffer firstPoint, firstCut;    ///< per piece, and the end: its PiecePoints, and its words of SurfaceArrays::cuts
  uint32_t points = 0, cuts = 0;
};

/// Points by which facets are told apart, and what was found of them.
struct SurfacePoints {
  Buffer at;          ///< PiecePoint
  Buffer classes;     ///< per point
  Buffer area;        ///< per point: for how much it stands, voxel faces
  Buffer facetStart;  ///< per solid voxel, and the end
  Buffer wideStart;   ///< likewise, of the facets whose surfels' sides take more than a byte
  uint32_t wide = 0;  ///< of these
};

/// As far as the surface has got. `addressOf`: a RecordMaker's of(), or a HostPass's in().
SurfaceArrays surfaceArrays(const FacetList& list, const auto& addressOf) {
  const Surface& s = list.surface;
  SurfaceArrays arrays{};
  arrays.corners = addressOf(s.corners);
  if (s.pieces) {
    arrays.pieces = addressOf(s.pieces);
    arrays.boxes = addressOf(s.boxes);
    arrays.groups = addressOf(s.groups);
    arrays.sides = addressOf(s.sides);
    arrays.cuts = addressOf(s.cuts);
  }
  if (s.surfels) {
    arrays.firstPiece = addressOf(s.firstPiece);
    arrays.voxel = addressOf(list.voxel);
    arrays.surfels = addressOf(s.surfels);
    arrays.wideSides = addressOf(s.wideSides);
    arrays.area = addressOf(list.area);
  }
  if (s.links) {
    arrays.linkMasks = addressOf(s.linkMasks);
    arrays.firstLinks = addressOf(s.firstLinks);
    arrays.links = addressOf(s.links);
  }
  return arrays;
}

/// Puts the pieces of each voxel in order, and finds area and box of each, and how many points and cuts it has.
void sortAndShape(Context& context, ListedBy by, const Buffer& corners, const Buffer& unsorted, const SurfacePieces& p);
/// The points, each one's facet among those of its voxel, and how many facets each voxel has.
void findClasses(Context& context, ListedBy by, const SurfacePieces& pieces, const FacetList& list,
                 const SurfacePoints& p);
/// The facets that the points make up: where they are, which sides of pieces belong to them, area and surfels; and
/// `facings` of these.
void fillFacets(Context& context, ListedBy by, const Buffer& gridRecord, const SurfacePieces& pieces,
                const SurfacePoints& points, const FacetList& list, const Buffer& facings);
/// Which facets of the voxels around each facet continue its surface, and how many.
void findLinks(Context& context, ListedBy by, const FacetList& list, const Buffer& facings, const Buffer& found);
/// Albedo and exitance of the facets from those of their pieces, and their normals. `stage`: whose time it is.
void meanFacets(Context& context, ListedBy by, const char* stage, const FacetParts& parts, const FacetList& list,
                const Buffer& pieceAlbedo, const Buffer& pieceEmission);

}  // namespace irad
