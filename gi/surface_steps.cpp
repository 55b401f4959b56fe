#include "gi/surface_steps.h"

#include <vector>

#include "gi/host_pass.h"
#include "gi/surface_on_host.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"

namespace irad {
namespace {

// What kernels take, or the host in their place; `pass`: a Pass or a HostPass.

SortPiecesPush piecesToSort(auto& pass, const Buffer& corners, const Buffer& unsorted, const SurfacePieces& p) {
  SortPiecesPush push{};
  push.solid = pass.in(p.voxel);
  push.firstPiece = pass.in(p.first);
  push.pieces = pass.out(unsorted);
  push.sorted = pass.out(p.triangle);
  push.pieceVoxel = pass.out(p.pieceVoxel);
  push.corners = pass.in(corners);
  push.count = p.solid;
  return push;
}

PieceShapePush piecesToShape(auto& pass, const Buffer& corners, const SurfacePieces& p) {
  PieceShapePush push{};
  push.pieceVoxel = pass.in(p.pieceVoxel);
  push.pieces = pass.in(p.triangle);
  push.solid = pass.in(p.voxel);
  push.firstPiece = pass.in(p.first);
  push.corners = pass.in(corners);
  push.area = pass.out(p.area);
  push.facings = pass.out(p.facings);
  push.boxes = pass.out(p.boxes);
  push.points = pass.out(p.firstPoint);
  push.cuts = pass.out(p.firstCut);
  push.count = p.count;
  return push;
}

PiecePointsPush piecesWithPoints(auto& pass, const SurfacePieces& pieces, const Surface& surface,
                                 const SurfacePoints& p) {
  PiecePointsPush push{};
  push.pieceVoxel = pass.in(pieces.pieceVoxel);
  push.solid = pass.in(pieces.voxel);
  push.firstPiece = pass.in(pieces.first);
  push.area = pass.in(pieces.area);
  push.firstPoint = pass.in(pieces.firstPoint);
  push.firstCut = pass.in(pieces.firstCut);
  push.points = pass.out(p.at);
  push.classes = pass.out(p.classes);
  push.sides = pass.out(surface.sides);
  push.cuts = pass.out(surface.cuts);
  push.count = pieces.count;
  return push;
}

ClassPointsPush classPoints(auto& pass, const SurfacePieces& pieces, const SurfacePoints& p) {
  ClassPointsPush push{};
  push.solid = pass.in(pieces.voxel);
  push.firstPiece = pass.in(pieces.first);
  push.area = pass.in(pieces.area);
  push.facings = pass.in(pieces.facings);
  push.firstPoint = pass.in(pieces.firstPoint);
  push.points = pass.in(p.at);
  push.classes = pass.accumulate(p.classes);
  push.facets = pass.accumulate(p.facetStart);
  push.wide = pass.accumulate(p.wideStart);
  push.count = pieces.solid;
  return push;
}

PieceSidesPush sidesToFind(auto& pass, const Buffer& gridRecord, const SurfacePieces& pieces,
                           const SurfacePoints& points, const FacetList& list) {
  PieceSidesPush push{};
  push.grid = pass.in(gridRecord);
  push.pieceVoxel = pass.in(pieces.pieceVoxel);
  push.solid = pass.in(pieces.voxel);
  push.firstPiece = pass.in(pieces.first);
  push.firstPoint = pass.in(pieces.firstPoint);
  push.classes = pass.out(points.classes);
  push.points = pass.in(points.at);
  push.pieceArea = pass.in(pieces.area);
  push.pointArea = pass.out(points.area);
  push.facetStart = pass.in(points.facetStart);
  pass.out(list.surface.sides);
  pass.out(list.surface.cuts);
  push.voxel = pass.out(list.voxel);
  push.reverse = pass.out(list.reverse);
  push.facetPiece = pass.out(list.surface.firstPiece);
  push.count = pieces.count;
  return push;
}

FacetSurfelsPush surfelsToPlace(auto& pass, const SurfacePieces& pieces, const SurfacePoints& points,
                                const FacetList& list, const Buffer& facings) {
  FacetSurfelsPush push{};
  push.voxel = pass.in(list.voxel);
  push.reverse = pass.in(list.reverse);
  push.firstPoint = pass.in(pieces.firstPoint);
  push.classes = pass.in(points.classes);
  push.points = pass.in(points.at);
  push.pointArea = pass.in(points.area);
  push.pieceVoxel = pass.in(pieces.pieceVoxel);
  push.wideStart = pass.in(points.wideStart);
  push.surfels = pass.out(list.surface.surfels);
  push.wideSides = pass.out(list.surface.wideSides);
  push.facings = pass.out(facings);
  push.area = pass.out(list.area);
  push.dims = list.grid.dims;
  push.count = list.count;
  return push;
}

LinkFacetsPush facetsToLink(auto& pass, const FacetList& list, const Buffer& facings, const Buffer& found) {
  LinkFacetsPush push{};
  push.voxel = pass.in(list.voxel);
  push.reverse = pass.in(list.reverse);
  push.facings = pass.in(facings);
  push.found = pass.accumulate(found);
  push.masks = pass.accumulate(list.surface.linkMasks);
  push.counts = pass.accumulate(list.surface.firstLinks);
  push.dims = list.grid.dims;
  push.count = list.count;
  return push;
}

FacetMeanPush facetsToMean(auto& pass, const FacetParts& parts, const FacetList& list, const Buffer& pieceAlbedo,
                           const Buffer& pieceEmission) {
  FacetMeanPush push{};
  push.voxel = pass.in(list.voxel);
  push.reverse = pass.in(list.reverse);
  push.firstPoint = pass.in(parts.firstPoint);
  push.classes = pass.in(parts.classes);
  push.points = pass.in(parts.points);
  push.pointArea = pass.in(parts.pointArea);
  push.pieceAlbedo = pass.in(pieceAlbedo);
  push.pieceEmission = pass.in(pieceEmission);
  push.shape = pass.out(list.shape);
  push.albedo = pass.out(list.albedo);
  push.emission = pass.out(list.emission);
  push.dims = list.grid.dims;
  push.count = list.count;
  push.encoding = list.encoding;
  push.hasEmission = list.hasEmission;
  return push;
}

}  // namespace

void sortAndShape(Context& context, ListedBy by, const Buffer& corners, const Buffer& unsorted,
                  const SurfacePieces& p) {
  if (by == ListedBy::host) {
    HostPass pass(context);
    const SortPiecesPush sort = piecesToSort(pass, corners, unsorted, p);
    const PieceShapePush shape = piecesToShape(pass, corners, p);
    pass.run(kListStage, [&] {
      sortPiecesOnHost(sort);
      shapePiecesOnHost(shape);
    });
    return;
  }
  Frame frame = context.begin();
  Pass sort = frame.pass(kListStage);
  sort.shader("gi/sort_pieces.comp")
      .constant(CONSTANT_CLIPS_SHARED, context.device.isCpu)
      .push(piecesToSort(sort, corners, unsorted, p))
      .dispatchWorkgroups(p.solid);
  Pass shape = frame.pass(kListStage);
  shape.shader("gi/piece_shape.comp")
      .constant(CONSTANT_CLIPS_SHARED, context.device.isCpu)
      .push(piecesToShape(shape, corners, p))
      .dispatch(p.count);
  frame.submit();
}

void findClasses(Context& context, ListedBy by, const SurfacePieces& pieces, const FacetList& list,
                 const SurfacePoints& p) {
  if (by == ListedBy::host) {
    HostPass pass(context);
    const SurfaceArrays surface = surfaceArrays(list, [&](const Buffer& b) { return pass.in(b); });
    const PiecePointsPush points = piecesWithPoints(pass, pieces, list.surface, p);
    const ClassPointsPush classes = classPoints(pass, pieces, p);
    pass.run(kListStage, [&] {
      findPointsOnHost(points, surface);
      classPointsOnHost(classes, surface);
    });
    return;
  }
  const Buffer crowds = facetWords(context.device, "voxels with many points", pieces.solid);
  const Buffer crowdCount = facetWords(context.device, "number of these", 1);
  const auto push = [&](Pass& pass) {
    ClassPointsPush push = classPoints(pass, pieces, p);
    push.surface = pass.in(list.surface.record);
    push.crowds = pass.accumulate(crowds);
    push.crowdCount = pass.accumulate(crowdCount);
    return push;
  };
  {
    Frame frame = context.begin();
    Pass points = frame.pass(kListStage);
    PiecePointsPush toFind = piecesWithPoints(points, pieces, list.surface, p);
    toFind.surface = points.in(list.surface.record);
    points.shader("gi/piece_points.comp")
        .constant(CONSTANT_CLIPS_SHARED, context.device.isCpu)
        .push(toFind)
        .dispatch(pieces.count);
    frame.pass(kListStage).fill(crowdCount, 0);
    Pass pass = frame.pass(kListStage);
    pass.shader("gi/class_points.comp").push(push(pass)).dispatch(pieces.solid);
    frame.submit();
  }
  const uint32_t found = downloadAs<uint32_t>(context, crowdCount).at(0);
  if (found == 0) return;
  Frame frame = context.begin();
  Pass pass = frame.pass(kListStage);
  ClassPointsPush ofCrowds = push(pass);
  ofCrowds.count = found;
  pass.shader("gi/class_crowd.comp").push(ofCrowds).dispatchWorkgroups(found);
  frame.submit();
}

void fillFacets(Context& context, ListedBy by, const Buffer& gridRecord, const SurfacePieces& pieces,
                const SurfacePoints& points, const FacetList& list, const Buffer& facings) {
  const Surface& surface = list.surface;
  Frame frame = context.begin();
  frame.pass(kListStage).copy(pieces.first, surface.firstPiece, 4, 4ull * pieces.solid, 4ull * list.count);
  if (by == ListedBy::host) {
    frame.submit();
    HostPass pass(context);
    const PieceSidesPush sides = sidesToFind(pass, gridRecord, pieces, points, list);
    const FacetSurfelsPush surfels = surfelsToPlace(pass, pieces, points, list, facings);
    const SurfaceArrays arrays = surfaceArrays(list, [&](const Buffer& b) { return pass.in(b); });
    pass.run(kListStage, [&] {
      findSidesOnHost(sides, arrays);
      placeSurfelsOnHost(surfels, arrays);
    });
    return;
  }
  Pass sides = frame.pass(kListStage);
  PieceSidesPush toFind = sidesToFind(sides, gridRecord, pieces, points, list);
  toFind.surface = sides.in(surface.record);
  sides.shader("gi/piece_sides.comp").push(toFind).dispatch(pieces.count);
  Pass surfels = frame.pass(kListStage);
  FacetSurfelsPush toPlace = surfelsToPlace(surfels, pieces, points, list, facings);
  toPlace.surface = surfels.in(surface.record);
  surfels.shader("gi/facet_surfels.comp")
      .constant(CONSTANT_CLIPS_SHARED, context.device.isCpu)
      .push(toPlace)
      .dispatch(list.count);
  frame.submitAndWait();
}

void findLinks(Context& context, ListedBy by, const FacetList& list, const Buffer& facings, const Buffer& found) {
  const Surface& surface = list.surface;
  const uint64_t surfels = uint64_t{FACET_SURFELS} * list.count;
  if (by == ListedBy::host) {
    HostPass pass(context);
    LinkFacetsPush push = facetsToLink(pass, list, facings, found);
    const SurfaceArrays arrays = surfaceArrays(list, [&](const Buffer& b) { return pass.in(b); });
    pass.run(kListStage, [&] {
      std::vector<glm::vec4> points(surfels);
      push.points = Vec4Array(points.data());
      linkFacetsOnHost(push, arrays);
    });
    return;
  }
  const Buffer at(context.device, "surfels to link", Subsystem::Facets, sizeof(glm::vec4) * surfels);
  Frame frame = context.begin();
  Pass place = frame.pass(kListStage);
  LinkPointsPush points{};
  points.surface = place.in(surface.record);
  points.reverse = place.in(list.reverse);
  points.points = place.out(at);
  points.dims = list.grid.dims;
  points.count = list.count;
  place.shader("gi/link_points.comp").push(points).dispatch(surfels);
  Pass pass = frame.pass(kListStage);
  LinkFacetsPush push = facetsToLink(pass, list, facings, found);
  push.surface = pass.in(surface.record);
  push.points = pass.in(at);
  pass.shader("gi/link_facets.comp").push(push).dispatchWorkgroups((list.count + LINK_FACETS - 1) / LINK_FACETS);
  frame.submit();
}

void meanFacets(Context& context, ListedBy by, const char* stage, const FacetParts& parts, const FacetList& list,
                const Buffer& pieceAlbedo, const Buffer& pieceEmission) {
  if (by == ListedBy::host) {
    HostPass pass(context);
    const SurfaceArrays surface = surfaceArrays(list, [&](const Buffer& b) { return pass.in(b); });
    const FacetMeanPush push = facetsToMean(pass, parts, list, pieceAlbedo, pieceEmission);
    pass.run(stage, [&] { meanFacetsOnHost(push, surface); });
    return;
  }
  Frame frame = context.begin();
  Pass pass = frame.pass(stage);
  FacetMeanPush push = facetsToMean(pass, parts, list, pieceAlbedo, pieceEmission);
  push.surface = pass.in(list.surface.record);
  pass.shader("gi/facet_mean.comp").push(push).dispatch(list.count);
  frame.submitAndWait();
}

}  // namespace irad
