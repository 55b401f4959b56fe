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
#include "gi/surface_steps.h"
#include "gi/voxel_pass.h"
#include "renderer/base/error.h"
#include "renderer/frame/record.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/sky.h"
#include "shaders/shared/surface.h"

namespace irad {
namespace {

void makeRecord(Context& context, FacetList& list) {
  RecordMaker record(context, "surface record", Subsystem::Facets, sizeof(SurfaceArrays));
  SurfaceArrays arrays = surfaceArrays(list, [&](const Buffer& buffer) { return record.of(buffer); });
  if (list.outer) arrays.outer = record.of(list.outer.record);
  list.surface.record = record.make(arrays);
}

/// Counts the pieces of each voxel, or writes them where `counts` says that the voxel's next one belongs.
/// The host does so at once, in the middle of the frame (gi/host_pass.h).
void listOrCount(Frame& frame, ListedBy by, const SceneOnDevice& scene, const Buffer& grid, const Buffer& corners,
                 const Tiles& tiles, const std::vector<TriangleRange>& ranges, const Buffer& counts,
                 const Buffer* pieces) {
  if (ranges.empty()) return;
  ListPiecesPush push{};
  push.lists = pieces != nullptr;
  const auto take = [&](auto& pass) {
    push.grid = pass.in(grid);
    push.corners = pass.in(corners);
    push.counts = pass.accumulate(counts);
    if (pieces) push.pieces = pass.accumulate(*pieces);
  };
  if (by == ListedBy::host) {
    HostPass pass(frame);
    take(pass);
    GpuScene record{};
    record.positions = pass.in(scene.positions);
    record.indices = pass.in(scene.indices);
    push.scene = SceneArray(&record);
    push.endTriangle = scene.scene.triangleCount();
    pass.run(kVoxelizeStage, [&] { listPiecesOnHost(push); });
    return;
  }
  Pass pass = frame.pass(kVoxelizeStage);
  take(pass);
  push.scene = pass.in(scene.record);
  push.tileStart = pass.in(tiles.starts);
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

SurfacePieces listPieces(Context& context, ListedBy by, const SceneOnDevice& scene, const Grid& grid,
                         const Buffer& gridRecord, const Buffer& corners, const std::function<void()>& look) {
  const Device& device = context.device;
  SurfacePieces p;
  const auto ranges = scene.scene.triangleCount() > 0 ? triangleRanges(scene) : std::vector<TriangleRange>{};
  const Tiles tiles = ranges.empty() || by == ListedBy::host ? Tiles{} : countTiles(context, scene, gridRecord, ranges);
  Buffer counts = facetWords(device, "pieces of voxels", grid.voxels);
  SolidPush push{};
  push.blocks = 1u << (grid.mortonBits.x + grid.mortonBits.y + grid.mortonBits.z - 6);
  Buffer blockSolid = facetWords(device, "solid voxels of blocks", push.blocks),
         blockPieces = facetWords(device, "pieces of blocks", push.blocks),
         solid = facetWords(device, "solid voxels", 1), pieces = facetWords(device, "pieces", 1),
         most = facetWords(device, "most pieces of a voxel", 1);
  {
    Frame frame = context.begin();
    frame.pass(kVoxelizeStage).fill(counts, 0);
    frame.pass(kVoxelizeStage).fill(most, 0);
    listOrCount(frame, by, scene, gridRecord, corners, tiles, ranges, counts, nullptr);
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

  p.voxel = facetWords(device, "solid voxels", p.solid);
  p.first = facetWords(device, "first pieces of voxels", uint64_t{p.solid} + 1);
  p.triangle = facetWords(device, "pieces' triangles", p.count);
  p.pieceVoxel = facetWords(device, "pieces' voxels", p.count);
  p.area = facetWords(device, "pieces' areas", p.count);
  p.facings = facetWords(device, "pieces' facings", 3ull * p.count);
  p.boxes = facetWords(device, "pieces' boxes", p.count);
  p.groups = facetWords(device, "boxes of groups", groupPlaces(p.count));
  p.firstPoint = facetWords(device, "pieces' points", uint64_t{p.count} + 1);
  p.firstCut = facetWords(device, "pieces' cuts", uint64_t{p.count} + 1);
  const Buffer unsorted = facetWords(device, "unsorted pieces", p.count);
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
    listOrCount(frame, by, scene, gridRecord, corners, tiles, ranges, counts, &unsorted);
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
void findMasks(Context& context, const SceneOnDevice& scene, const Buffer& grid, const SurfacePieces& pieces,
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

/// The points of all pieces, in the list's surface the cuts of those that others stand on, and each point's facet.
SurfacePoints classifyPoints(Context& context, ListedBy by, const SurfacePieces& pieces, const FacetList& list,
                             uint32_t& facets) {
  const Device& device = context.device;
  SurfacePoints p;
  p.at = Buffer(device, "pieces' points", Subsystem::Facets, sizeof(PiecePoint) * uint64_t{pieces.points});
  p.classes = facetWords(device, "points' facets", pieces.points);
  p.area = facetWords(device, "points' areas", pieces.points);
  p.facetStart = facetWords(device, "facets of voxels", uint64_t{pieces.solid} + 1);
  p.wideStart = facetWords(device, "wide facets of voxels", uint64_t{pieces.solid} + 1);
  const Buffer total = facetWords(device, "facets", 1), wide = facetWords(device, "wide facets", 1);
  findClasses(context, by, pieces, list, p);
  Frame frame = context.begin();
  scanToEnd(frame, p.facetStart, pieces.solid, total, facets);
  scanToEnd(frame, p.wideStart, pieces.solid, wide, p.wide);
  frame.submitAndWait();
  return p;
}

/// Which facets continue the surface of which: masks and, where `list` says that each facet's begin, links.
void linkFacets(Context& context, ListedBy by, FacetList& list, const Buffer& facings) {
  Surface& surface = list.surface;
  const Device& device = context.device;
  const Buffer found(device, "links as found", Subsystem::Facets, uint64_t{FACET_LINKS} * list.count);
  const Buffer total = facetWords(device, "links", 1);
  findLinks(context, by, list, facings, found);
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
  surface.corners = facetWords(device, "triangles' corners", 12ull * triangles);
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
  SurfacePieces pieces = listPieces(context, by, scene, list.grid, grid, surface.corners, look);
  look();

  list.solidVoxels = pieces.solid;
  surface.pieces = std::move(pieces.triangle);
  surface.boxes = std::move(pieces.boxes);
  surface.groups = std::move(pieces.groups);
  surface.sides = facetWords(device, "pieces' sides", pieces.count);
  surface.cuts = facetWords(device, "pieces' cuts", pieces.cuts);
  makeRecord(context, list);
  SurfacePoints points;
  findMasks(context, scene, grid, pieces, surface);
  look();
  if (pieces.solid > 0) points = classifyPoints(context, by, pieces, list, list.count);
  look();
  pieces.facings = Buffer();
  allocateFacets(device, list);
  surface.firstPiece = facetWords(device, "first pieces of facets", uint64_t{list.count} + 1);
  surface.surfels = facetWords(device, "surfels", uint64_t{SURFEL_WORDS} * list.count);
  surface.wideSides = facetWords(device, "wide sides of surfels", uint64_t{WIDE_WORDS} * points.wide);
  surface.linkMasks = facetWords(device, "masks of links", list.count);
  surface.firstLinks = facetWords(device, "first links of facets", uint64_t{list.count} + 1);
  makeRecord(context, list);
  {
    Frame frame = context.begin();
    frame.pass(kListStage).fill(list.reverse, NO_FACET);
    frame.submit();
  }
  if (list.count > 0) {
    const Buffer facings = facetWords(device, "facings of facets", 3ull * list.count);
    fillFacets(context, by, grid, pieces, points, list, facings);
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
                    const FacetParts& parts, const FacetList& list, ListedBy by) {
  const Surface& surface = list.surface;
  const Device& device = context.device;
  const Order order =
      groupByMaterial(scene, downloadAs<uint32_t>(context, surface.pieces), kColorTextures | MATERIAL_NORMAL_TEXTURE);
  const Buffer ordered =
      makeBuffer<uint32_t>(context, "pieces by material", Subsystem::Facets, std::span<const uint32_t>(order.items));
  const Buffer clamped = facetWords(device, "clamped albedo", 1);
  const Buffer albedo = facetWords(device, "pieces' albedo", 3ull * parts.pieces),
               emission = facetWords(device, "pieces' exitance", list.hasEmission ? 3ull * parts.pieces : 0);
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
  frame.submit();
  meanFacets(context, by, stage, parts, list, albedo, emission);
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
    facets.clampedAlbedo = shadeParts(context, kVoxelizeStage, scene, listed.grid, listed.parts, facets, by);
  recordFacets(context, facets);
  return std::move(facets);
}

FacetParts listParts(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings) {
  return std::move(listSurface(context, scene, shape, settings, listsFaster(context.device)).parts);
}

}  // namespace irad
