#include "gi/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "gi/facets.h"
#include "gi/grid.h"
#include "gi/group_by_material.h"
#include "gi/host_pass.h"
#include "gi/scan.h"
#include "gi/scene_shape.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/surface_on_host.h"
#include "gi/voxel_pass.h"
#include "renderer/base/error.h"
#include "renderer/frame/record.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/sky.h"
#include "shaders/shared/surface.h"

namespace irad {
namespace {

constexpr const char* kListStage = "GI CompactList";

Buffer words(const Device& device, const char* name, uint64_t count) {
  return Buffer(device, name, Subsystem::Facets, 4 * count);
}

/// Which triangles have a piece in which voxel.
struct Pieces {
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
struct Points {
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

void makeRecord(Context& context, FacetList& list) {
  RecordMaker record(context, "surface record", Subsystem::Facets, sizeof(SurfaceArrays));
  SurfaceArrays arrays = surfaceArrays(list, [&](const Buffer& buffer) { return record.of(buffer); });
  if (list.outer) arrays.outer = record.of(list.outer.record);
  list.surface.record = record.make(arrays);
}

/// Counts the pieces of each voxel, or writes them where `counts` says that the voxel's next one belongs.
void listOrCount(Frame& frame, const SceneOnDevice& scene, const Buffer& grid, const Buffer& corners,
                 const Tiles& tiles, const std::vector<TriangleRange>& ranges, const Buffer& counts,
                 const Buffer* pieces) {
  if (ranges.empty()) return;
  Pass pass = frame.pass(kVoxelizeStage);
  ListPiecesPush push{};
  push.scene = pass.in(scene.record);
  push.grid = pass.in(grid);
  push.corners = pass.in(corners);
  push.tileStart = pass.in(tiles.starts);
  push.counts = pass.accumulate(counts);
  if (pieces) push.pieces = pass.accumulate(*pieces);
  push.lists = pieces != nullptr;
  // Its polygons stay in shared memory on GPUs, too: it is faster so.
  pass.shader("gi/list_pieces.comp").run([&](Commands& commands) {
    for (size_t i = 0; i < ranges.size(); ++i) {
      push.firstTriangle = ranges[i].first;
      push.endTriangle = ranges[i].end;
      push.firstTile = tiles.bounds[i];
      push.tileCount = tiles.bounds[i + 1] - tiles.bounds[i];
      if (push.tileCount == 0) continue;
      commands.push(push);
      commands.dispatch(push.tileCount);
    }
  });
}

/// Prefix sums of `values`, and their total behind the last; `sum` is known when the frame is done.
void scanToEnd(Frame& frame, const Buffer& values, uint32_t count, const Buffer& total, uint32_t& sum) {
  exclusiveScan(frame, kListStage, values, count, total);
  frame.pass(kListStage).copy(total, values, 4, 0, 4ull * count);
  frame.readback(total, 0, 4, [&sum](std::span<const uint8_t> b) { std::memcpy(&sum, b.data(), b.size()); });
}

// What kernels take, or the host in their place; `pass`: a Pass or a HostPass.

SortPiecesPush piecesToSort(auto& pass, const Buffer& corners, const Buffer& unsorted, const Pieces& p) {
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

PieceShapePush piecesToShape(auto& pass, const Buffer& corners, const Pieces& p) {
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

/// Puts the pieces of each voxel in order, and finds area and box of each, and how many points and cuts it has.
void sortAndShape(Context& context, ListedBy by, const Buffer& corners, const Buffer& unsorted, const Pieces& p) {
  if (by == ListedBy::host) {
    timedOnHost(context, kListStage, [&] {
      HostPass pass(context);
      sortPiecesOnHost(piecesToSort(pass, corners, unsorted, p));
      shapePiecesOnHost(piecesToShape(pass, corners, p));
      pass.finish();
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

Pieces listPieces(Context& context, ListedBy by, const SceneOnDevice& scene, const Grid& grid, const Buffer& gridRecord,
                  const Buffer& corners, const std::function<void()>& look) {
  const Device& device = context.device;
  Pieces p;
  const auto ranges = scene.scene.triangleCount() > 0 ? triangleRanges(scene) : std::vector<TriangleRange>{};
  const Tiles tiles = ranges.empty() ? Tiles{} : countTiles(context, scene, gridRecord, ranges);
  Buffer counts = words(device, "pieces of voxels", grid.voxels);
  SolidPush push{};
  push.blocks = 1u << (grid.mortonBits.x + grid.mortonBits.y + grid.mortonBits.z - 6);
  Buffer blockSolid = words(device, "solid voxels of blocks", push.blocks),
         blockPieces = words(device, "pieces of blocks", push.blocks), solid = words(device, "solid voxels", 1),
         pieces = words(device, "pieces", 1), most = words(device, "most pieces of a voxel", 1);
  {
    Frame frame = context.begin();
    frame.pass(kVoxelizeStage).fill(counts, 0);
    frame.pass(kVoxelizeStage).fill(most, 0);
    listOrCount(frame, scene, gridRecord, corners, tiles, ranges, counts, nullptr);
    Pass pass = frame.pass(kListStage);
    push.grid = pass.in(gridRecord);
    push.counts = pass.in(counts);
    push.blockSolid = pass.out(blockSolid);
    push.blockPieces = pass.out(blockPieces);
    push.most = pass.out(most);
    pass.shader("gi/solid_count.comp").push(push).dispatch(push.blocks);
    exclusiveScan(frame, kListStage, blockSolid, push.blocks, solid);
    exclusiveScan(frame, kListStage, blockPieces, push.blocks, pieces);
    frame.submitAndWait();
  }
  look();
  p.solid = downloadAs<uint32_t>(context, solid).at(0);
  p.count = downloadAs<uint32_t>(context, pieces).at(0);

  if (const uint32_t n = downloadAs<uint32_t>(context, most).at(0); n > MOST_PIECES)
    throw WorkError(fmt::format(
        "{}: a voxel holds pieces of {} triangles, more than {}: raise voxel.resolution, or simplify the mesh",
        scene.scene.path.string(), n, MOST_PIECES));

  p.voxel = words(device, "solid voxels", p.solid);
  p.first = words(device, "first pieces of voxels", uint64_t{p.solid} + 1);
  p.triangle = words(device, "pieces' triangles", p.count);
  p.pieceVoxel = words(device, "pieces' voxels", p.count);
  p.area = words(device, "pieces' areas", p.count);
  p.facings = words(device, "pieces' facings", 3ull * p.count);
  p.boxes = words(device, "pieces' boxes", p.count);
  p.groups = words(device, "boxes of groups", groupPlaces(p.count));
  p.firstPoint = words(device, "pieces' points", uint64_t{p.count} + 1);
  p.firstCut = words(device, "pieces' cuts", uint64_t{p.count} + 1);
  const Buffer unsorted = words(device, "unsorted pieces", p.count);
  {
    Frame frame = context.begin();
    frame.pass(kListStage).copy(pieces, p.first, 4, 0, 4ull * p.solid);
    Pass pass = frame.pass(kListStage);
    push.grid = pass.in(gridRecord);
    push.most = 0;
    push.counts = pass.out(counts);
    push.blockSolid = pass.in(blockSolid);
    push.blockPieces = pass.in(blockPieces);
    push.solid = pass.out(p.voxel);
    push.firstPiece = pass.out(p.first);
    pass.shader("gi/solid_emit.comp").push(push).dispatch(push.blocks);
    listOrCount(frame, scene, gridRecord, corners, tiles, ranges, counts, &unsorted);
    frame.submit();
  }
  if (p.count > 0) sortAndShape(context, by, corners, unsorted, p);
  Frame frame = context.begin();
  if (p.count > 0) {
    Pass pass = frame.pass(kListStage);
    PieceGroupsPush groups{};
    groups.firstPiece = pass.in(p.first);
    groups.boxes = pass.in(p.boxes);
    groups.groups = pass.out(p.groups);
    groups.count = p.solid;
    pass.shader("gi/piece_groups.comp").push(groups).dispatch(p.solid);
  }
  scanToEnd(frame, p.firstPoint, p.count, solid, p.points);
  scanToEnd(frame, p.firstCut, p.count, pieces, p.cuts);
  frame.submitAndWait();
  return p;
}

/// What alpha masks leave of the pieces, in `surface`.
void findMasks(Context& context, const SceneOnDevice& scene, const Buffer& grid, const Pieces& pieces,
               const Surface& surface) {
  const auto hasMask = [](uint32_t flags) { return (flags & MATERIAL_ALPHA_MASK) != 0; };
  const std::vector<uint32_t> flags = flagsOfTriangles(scene);
  if (std::none_of(flags.begin(), flags.end(), hasMask)) return;
  std::vector<uint32_t> masked, triangles;  // pieces, and theirs
  const std::vector<uint32_t> all = downloadAs<uint32_t>(context, surface.pieces);
  for (uint32_t i = 0; i < all.size(); ++i)
    if (const uint32_t triangle = all[i] & ~PIECE_SMALL; hasMask(flags[triangle])) {
      masked.push_back(i);
      triangles.push_back(triangle);
    }
  Order order = groupByMaterial(scene, triangles);
  for (uint32_t& item : order.items) item = masked[item];
  const Buffer ordered =
      makeBuffer<uint32_t>(context, "pieces with masks", Subsystem::Facets, std::span<const uint32_t>(order.items));
  Frame frame = context.begin();
  dispatchByMaterial(frame, kVoxelizeStage, "gi/piece_mask.comp", scene, order, [&](Pass& pass) {
    PieceMaskPush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(grid);
    push.order = pass.in(ordered);
    push.pieceVoxel = pass.in(pieces.pieceVoxel);
    push.solid = pass.in(pieces.voxel);
    push.pieces = pass.in(surface.pieces);
    push.firstCut = pass.in(pieces.firstCut);
    push.cuts = pass.out(surface.cuts);
    return push;
  });
  frame.submitAndWait();
}

// As above.

PiecePointsPush piecesWithPoints(auto& pass, const Pieces& pieces, const Surface& surface, const Points& p) {
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

ClassPointsPush classPoints(auto& pass, const Pieces& pieces, const Points& p) {
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

/// The points, each one's facet among those of its voxel, and how many facets each voxel has.
void findClasses(Context& context, ListedBy by, const Pieces& pieces, const FacetList& list, const Points& p) {
  if (by == ListedBy::host) {
    timedOnHost(context, kListStage, [&] {
      HostPass pass(context);
      const SurfaceArrays surface = surfaceArrays(list, [&](const Buffer& b) { return pass.in(b); });
      findPointsOnHost(piecesWithPoints(pass, pieces, list.surface, p), surface);
      classPointsOnHost(classPoints(pass, pieces, p), surface);
      pass.finish();
    });
    return;
  }
  const Buffer crowds = words(context.device, "voxels with many points", pieces.solid);
  const Buffer crowdCount = words(context.device, "number of these", 1);
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

/// The points of all pieces, in the list's surface the cuts of those that others stand on, and each point's facet.
Points classifyPoints(Context& context, ListedBy by, const Pieces& pieces, const FacetList& list, uint32_t& facets) {
  const Device& device = context.device;
  Points p;
  p.at = Buffer(device, "pieces' points", Subsystem::Facets, sizeof(PiecePoint) * uint64_t{pieces.points});
  p.classes = words(device, "points' facets", pieces.points);
  p.area = words(device, "points' areas", pieces.points);
  p.facetStart = words(device, "facets of voxels", uint64_t{pieces.solid} + 1);
  p.wideStart = words(device, "wide facets of voxels", uint64_t{pieces.solid} + 1);
  const Buffer total = words(device, "facets", 1), wide = words(device, "wide facets", 1);
  findClasses(context, by, pieces, list, p);
  Frame frame = context.begin();
  scanToEnd(frame, p.facetStart, pieces.solid, total, facets);
  scanToEnd(frame, p.wideStart, pieces.solid, wide, p.wide);
  frame.submitAndWait();
  return p;
}

/// The facets that the points make up: where they are, which sides of pieces belong to them, area and surfels.
void fillFacets(Context& context, const Buffer& gridRecord, const Pieces& pieces, const Points& points,
                const FacetList& list, const Buffer& facings) {
  const Surface& surface = list.surface;
  Frame frame = context.begin();
  frame.pass(kListStage).copy(pieces.first, surface.firstPiece, 4, 4ull * pieces.solid, 4ull * list.count);
  {
    Pass pass = frame.pass(kListStage);
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
    push.surface = pass.in(surface.record);
    pass.out(surface.sides);
    pass.out(surface.cuts);
    push.voxel = pass.out(list.voxel);
    push.reverse = pass.out(list.reverse);
    push.facetPiece = pass.out(surface.firstPiece);
    push.count = pieces.count;
    pass.shader("gi/piece_sides.comp").push(push).dispatch(pieces.count);
  }
  {
    Pass pass = frame.pass(kListStage);
    FacetSurfelsPush push{};
    push.surface = pass.in(surface.record);
    push.voxel = pass.in(list.voxel);
    push.reverse = pass.in(list.reverse);
    push.firstPoint = pass.in(pieces.firstPoint);
    push.classes = pass.in(points.classes);
    push.points = pass.in(points.at);
    push.pointArea = pass.in(points.area);
    push.pieceVoxel = pass.in(pieces.pieceVoxel);
    push.wideStart = pass.in(points.wideStart);
    push.surfels = pass.out(surface.surfels);
    push.wideSides = pass.out(surface.wideSides);
    push.facings = pass.out(facings);
    push.area = pass.out(list.area);
    push.dims = list.grid.dims;
    push.count = list.count;
    pass.shader("gi/facet_surfels.comp")
        .constant(CONSTANT_CLIPS_SHARED, context.device.isCpu)
        .push(push)
        .dispatch(list.count);
  }
  frame.submitAndWait();
}

/// As above.
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

/// Which facets of the voxels around each facet continue its surface, and how many. `at`: room for its surfels.
void findLinks(Context& context, ListedBy by, const FacetList& list, const Buffer& facings, const Buffer& at,
               const Buffer& found) {
  const Surface& surface = list.surface;
  if (by == ListedBy::host) {
    timedOnHost(context, kListStage, [&] {
      HostPass pass(context);
      LinkFacetsPush push = facetsToLink(pass, list, facings, found);
      push.points = pass.in(at);
      linkFacetsOnHost(push, surfaceArrays(list, [&](const Buffer& b) { return pass.in(b); }));
      pass.finish();
    });
    return;
  }
  Frame frame = context.begin();
  Pass surfels = frame.pass(kListStage);
  LinkPointsPush points{};
  points.surface = surfels.in(surface.record);
  points.reverse = surfels.in(list.reverse);
  points.points = surfels.out(at);
  points.dims = list.grid.dims;
  points.count = list.count;
  surfels.shader("gi/link_points.comp").push(points).dispatch(uint64_t{FACET_SURFELS} * list.count);
  Pass pass = frame.pass(kListStage);
  LinkFacetsPush push = facetsToLink(pass, list, facings, found);
  push.surface = pass.in(surface.record);
  push.points = pass.in(at);
  pass.shader("gi/link_facets.comp").push(push).dispatchWorkgroups((list.count + LINK_FACETS - 1) / LINK_FACETS);
  frame.submit();
}

/// Which facets continue the surface of which: masks and, where `list` says that each facet's begin, links.
void linkFacets(Context& context, ListedBy by, FacetList& list, const Buffer& facings) {
  Surface& surface = list.surface;
  const Device& device = context.device;
  const Buffer found(device, "links as found", Subsystem::Facets, uint64_t{FACET_LINKS} * list.count);
  const Buffer at(device, "surfels to link", Subsystem::Facets, sizeof(glm::vec4) * FACET_SURFELS * list.count);
  const Buffer total = words(device, "links", 1);
  findLinks(context, by, list, facings, at, found);
  uint32_t links = 0;
  {
    Frame frame = context.begin();
    scanToEnd(frame, surface.firstLinks, list.count, total, links);
    frame.submitAndWait();
  }
  surface.links = Buffer(device, "links of facets", Subsystem::Facets, links);
  Frame frame = context.begin();
  Pass pass = frame.pass(kListStage);
  PackLinksPush push{};
  push.found = pass.in(found);
  push.masks = pass.in(surface.linkMasks);
  push.firstLinks = pass.in(surface.firstLinks);
  push.links = pass.out(surface.links);
  push.count = list.count;
  pass.shader("gi/pack_links.comp").push(push).dispatch(list.count);
  frame.submitAndWait();
}

/// A list that is still to be shaded, and its parts.
struct Listed {
  FacetList list;
  Buffer grid;  ///< one Grid
  FacetParts parts;
};

Listed listSurface(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings,
                   ListedBy by, const std::function<void()>& watch = {}) {
  const auto look = [&] {
    if (watch) watch();
  };
  const Device& device = context.device;
  const uint32_t triangles = scene.scene.triangleCount();
  Listed listed;
  FacetList& list = listed.list;
  const SceneRegion& region = list.region = shape.region;
  list.grid = makeGrid(region.lo, region.hi, settings.voxel.resolution);
  list.encoding = settings.voxel.normals;
  list.hasEmission = keepsEmission(scene, settings);
  listed.grid = makeBuffer<Grid>(context, "grid", Subsystem::Voxels, std::span(&list.grid, 1));
  const Buffer& grid = listed.grid;
  Surface& surface = list.surface;
  const std::vector<uint32_t> flags = flagsOfTriangles(scene);
  surface.tinted = std::ranges::any_of(flags, [](uint32_t f) { return (f & MATERIAL_TRANSMISSIVE) != 0; });
  surface.corners = words(device, "triangles' corners", 12ull * triangles);
  const std::vector<uint32_t> repeated = repeatedTriangles(shape.samePlaces, flags);
  list.outer = makeOuter(context, scene, region, list.grid, repeated);
  if (surface.tinted && list.outer.count > (1u << TINT_SHIFT_SKY) - SKY_BINS)
    throw UsageError(fmt::format(
        "scene.region: {} points outside of it are more than rays can tell apart that panes tint", list.outer.count));
  const Buffer repeats = repeated.empty() ? Buffer()
                                          : makeBuffer<uint32_t>(context, "repeated triangles", Subsystem::Facets,
                                                                 std::span<const uint32_t>(repeated));
  {
    Frame frame = context.begin();
    Pass pass = frame.pass(kVoxelizeStage);
    SurfaceCornersPush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(grid);
    push.corners = pass.out(surface.corners);
    push.repeated = pass.inIfAny(repeats);
    push.hasRepeated = !repeated.empty();
    push.triangles = triangles;
    pass.shader("gi/surface_corners.comp").push(push).dispatch(triangles);
    frame.submit();
  }
  Pieces pieces = listPieces(context, by, scene, list.grid, grid, surface.corners, look);
  look();

  list.solidVoxels = pieces.solid;
  surface.pieces = std::move(pieces.triangle);
  surface.boxes = std::move(pieces.boxes);
  surface.groups = std::move(pieces.groups);
  surface.sides = words(device, "pieces' sides", pieces.count);
  surface.cuts = words(device, "pieces' cuts", pieces.cuts);
  makeRecord(context, list);
  Points points;
  findMasks(context, scene, grid, pieces, surface);
  look();
  if (pieces.solid > 0) points = classifyPoints(context, by, pieces, list, list.count);
  look();
  pieces.facings = Buffer();
  allocateFacets(device, list);
  surface.firstPiece = words(device, "first pieces of facets", uint64_t{list.count} + 1);
  surface.surfels = words(device, "surfels", uint64_t{SURFEL_WORDS} * list.count);
  surface.wideSides = words(device, "wide sides of surfels", uint64_t{WIDE_WORDS} * points.wide);
  surface.linkMasks = words(device, "masks of links", list.count);
  surface.firstLinks = words(device, "first links of facets", uint64_t{list.count} + 1);
  makeRecord(context, list);
  {
    Frame frame = context.begin();
    frame.pass(kListStage).fill(list.reverse, NO_FACET);
    frame.submit();
  }
  if (list.count > 0) {
    const Buffer facings = words(device, "facings of facets", 3ull * list.count);
    fillFacets(context, grid, pieces, points, list, facings);
    look();
    linkFacets(context, by, list, facings);
    makeRecord(context, list);
  }
  listed.parts = {.pieces = pieces.count,
                  .solid = std::move(pieces.voxel),
                  .pieceVoxel = std::move(pieces.pieceVoxel),
                  .firstPoint = std::move(pieces.firstPoint),
                  .points = std::move(points.at),
                  .classes = std::move(points.classes),
                  .pointArea = std::move(points.area)};
  return listed;
}

}  // namespace

/// Albedo and exitance of the pieces, then of the facets.
uint32_t shadeParts(Context& context, const char* stage, const SceneOnDevice& scene, const Buffer& gridRecord,
                    const FacetParts& parts, const FacetList& list) {
  const Surface& surface = list.surface;
  const Device& device = context.device;
  const Order order =
      groupByMaterial(scene, downloadAs<uint32_t>(context, surface.pieces), kColorTextures | MATERIAL_NORMAL_TEXTURE);
  const Buffer ordered =
      makeBuffer<uint32_t>(context, "pieces by material", Subsystem::Facets, std::span<const uint32_t>(order.items));
  const Buffer clamped = words(device, "clamped albedo", 1);
  const Buffer albedo = words(device, "pieces' albedo", 3ull * parts.pieces),
               emission = words(device, "pieces' exitance", list.hasEmission ? 3ull * parts.pieces : 0);
  Frame frame = context.begin();
  frame.pass(stage).fill(clamped, 0);
  dispatchByMaterial(frame, stage, "gi/piece_shade.comp", scene, order, [&](Pass& pass) {
    PieceShadePush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(gridRecord);
    push.order = pass.in(ordered);
    push.pieceVoxel = pass.in(parts.pieceVoxel);
    push.solid = pass.in(parts.solid);
    push.surface = pass.in(surface.record);
    push.albedo = pass.out(albedo);
    push.emission = pass.out(emission);
    push.clamped = pass.out(clamped);
    push.hasEmission = list.hasEmission;
    return push;
  });
  Pass pass = frame.pass(stage);
  FacetMeanPush push{};
  push.surface = pass.in(surface.record);
  push.voxel = pass.in(list.voxel);
  push.reverse = pass.in(list.reverse);
  push.firstPoint = pass.in(parts.firstPoint);
  push.classes = pass.in(parts.classes);
  push.points = pass.in(parts.points);
  push.pointArea = pass.in(parts.pointArea);
  push.pieceAlbedo = pass.in(albedo);
  push.pieceEmission = pass.in(emission);
  push.shape = pass.out(list.shape);
  push.albedo = pass.out(list.albedo);
  push.emission = pass.out(list.emission);
  push.dims = list.grid.dims;
  push.count = list.count;
  push.encoding = list.encoding;
  push.hasEmission = list.hasEmission;
  pass.shader("gi/facet_mean.comp").push(push).dispatch(list.count);
  frame.submitAndWait();
  return downloadAs<uint32_t>(context, clamped).at(0);
}

ListedBy listsFaster(const Device& device) {
  return device.isCpu ? ListedBy::host : ListedBy::kernels;
}

FacetList listFacets(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings,
                     ListedBy by, const std::function<void()>& watch) {
  Listed listed = listSurface(context, scene, shape, settings, by, watch);
  if (watch) watch();
  FacetList& facets = listed.list;
  if (facets.count > 0)
    facets.clampedAlbedo = shadeParts(context, kVoxelizeStage, scene, listed.grid, listed.parts, facets);
  recordFacets(context, facets);
  return std::move(facets);
}

FacetParts listParts(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings) {
  return std::move(listSurface(context, scene, shape, settings, listsFaster(context.device)).parts);
}

}  // namespace irad
