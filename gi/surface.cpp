#include "gi/surface.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "gi/facets.h"
#include "gi/grid.h"
#include "gi/group_by_material.h"
#include "gi/scan.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/voxel_pass.h"
#include "renderer/base/error.h"
#include "renderer/frame/record.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/constants.h"
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
  Buffer pieceVoxel;              ///< packVoxel
  Buffer area;                    ///< float, voxel faces
};

/// Counts the pieces of each voxel, or writes them where `counts` says that the voxel's next one belongs.
void listOrCount(Frame& frame, const SceneOnDevice& scene, const Buffer& grid, const Tiles& tiles,
                 const std::vector<TriangleRange>& ranges, const Buffer& counts, const Buffer* pieces) {
  for (const bool masked : {false, true}) {
    if (std::ranges::count(ranges, masked, &TriangleRange::masked) == 0) continue;
    Pass pass = frame.pass(kVoxelizeStage);
    ListPiecesPush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(grid);
    push.tileStart = pass.in(tiles.starts);
    push.counts = pass.accumulate(counts);
    if (pieces) push.pieces = pass.accumulate(*pieces);
    push.lists = pieces != nullptr;
    pass.shader("gi/list_pieces.comp").constant(CONSTANT_SAMPLES_TEXTURES, masked).run([&](Commands& commands) {
      for (size_t i = 0; i < ranges.size(); ++i) {
        push.firstTriangle = ranges[i].first;
        push.endTriangle = ranges[i].end;
        push.firstTile = tiles.bounds[i];
        push.tileCount = tiles.bounds[i + 1] - tiles.bounds[i];
        if (ranges[i].masked != masked || push.tileCount == 0) continue;
        commands.bindMaterial(scene.materialSets.at(ranges[i].material));
        commands.push(push);
        commands.dispatch(push.tileCount);
      }
    });
  }
}

Pieces listPieces(Context& context, const SceneOnDevice& scene, const Grid& grid, const Buffer& gridRecord,
                  const Buffer& corners) {
  const Device& device = context.device;
  Pieces p;
  const auto ranges = scene.scene.triangleCount() > 0 ? triangleRanges(scene) : std::vector<TriangleRange>{};
  const Tiles tiles = ranges.empty() ? Tiles{} : countTiles(context, scene, gridRecord, ranges);
  Buffer counts = words(device, "pieces of voxels", grid.voxels);
  SolidPush push{};
  push.blocks = 1u << (grid.mortonBits.x + grid.mortonBits.y + grid.mortonBits.z - 6);
  Buffer blockSolid = words(device, "solid voxels of blocks", push.blocks),
         blockPieces = words(device, "pieces of blocks", push.blocks), solid = words(device, "solid voxels", 1),
         pieces = words(device, "pieces", 1);
  {
    Frame frame = context.begin();
    frame.pass(kVoxelizeStage).fill(counts, 0);
    listOrCount(frame, scene, gridRecord, tiles, ranges, counts, nullptr);
    Pass pass = frame.pass(kListStage);
    push.grid = pass.in(gridRecord);
    push.counts = pass.in(counts);
    push.blockSolid = pass.out(blockSolid);
    push.blockPieces = pass.out(blockPieces);
    pass.shader("gi/solid_count.comp").push(push).dispatch(push.blocks);
    exclusiveScan(frame, kListStage, blockSolid, push.blocks, solid);
    exclusiveScan(frame, kListStage, blockPieces, push.blocks, pieces);
    frame.submitAndWait();
  }
  p.solid = downloadAs<uint32_t>(context, solid).at(0);
  p.count = downloadAs<uint32_t>(context, pieces).at(0);

  p.voxel = words(device, "solid voxels", p.solid);
  p.first = words(device, "first pieces of voxels", uint64_t{p.solid} + 1);
  p.triangle = words(device, "pieces' triangles", p.count);
  p.pieceVoxel = words(device, "pieces' voxels", p.count);
  p.area = words(device, "pieces' areas", p.count);
  Buffer unsorted = words(device, "unsorted pieces", p.count);
  Frame frame = context.begin();
  frame.pass(kListStage).copy(pieces, p.first, 4, 0, 4ull * p.solid);
  {
    Pass pass = frame.pass(kListStage);
    push.grid = pass.in(gridRecord);
    push.counts = pass.out(counts);
    push.blockSolid = pass.in(blockSolid);
    push.blockPieces = pass.in(blockPieces);
    push.solid = pass.out(p.voxel);
    push.firstPiece = pass.out(p.first);
    pass.shader("gi/solid_emit.comp").push(push).dispatch(push.blocks);
  }
  listOrCount(frame, scene, gridRecord, tiles, ranges, counts, &unsorted);
  if (p.count > 0) {
    {
      Pass pass = frame.pass(kListStage);
      SortPiecesPush sort{};
      sort.solid = pass.in(p.voxel);
      sort.firstPiece = pass.in(p.first);
      sort.pieces = pass.in(unsorted);
      sort.sorted = pass.out(p.triangle);
      sort.pieceVoxel = pass.out(p.pieceVoxel);
      sort.count = p.solid;
      pass.shader("gi/sort_pieces.comp").push(sort).dispatchWorkgroups(p.solid);
    }
    Pass pass = frame.pass(kListStage);
    PieceAreaPush area{};
    area.pieceVoxel = pass.in(p.pieceVoxel);
    area.pieces = pass.in(p.triangle);
    area.corners = pass.in(corners);
    area.area = pass.out(p.area);
    area.count = p.count;
    pass.shader("gi/piece_area.comp").push(area).dispatch(p.count);
  }
  frame.submitAndWait();
  return p;
}

/// Records gi/class_facets.comp, which counts the facets of each solid voxel or makes them.
void classify(Frame& frame, const SceneOnDevice& scene, const Buffer& gridRecord, const Pieces& pieces,
              const Buffer& triangles, const Surface& surface, const Buffer& facetStart, FacetList* list) {
  Pass pass = frame.pass(kListStage);
  ClassFacetsPush push{};
  push.scene = pass.in(scene.record);
  push.grid = pass.in(gridRecord);
  push.solid = pass.in(pieces.voxel);
  push.firstPiece = pass.in(pieces.first);
  push.pieces = pass.in(triangles);
  push.pieceArea = pass.in(pieces.area);
  push.surface = pass.in(surface.record);
  push.facetStart = list ? pass.in(facetStart) : pass.out(facetStart);
  if (list) {
    push.voxel = pass.out(list->voxel);
    push.triangle = pass.out(list->triangle);
    push.reverse = pass.out(list->reverse);
    for (const Buffer& made : {std::cref(surface.firstPiece), std::cref(surface.sides), std::cref(surface.surfels)})
      pass.out(made);
    pass.out(list->area);
  }
  push.count = pieces.solid;
  push.makes = list != nullptr;
  pass.shader("gi/class_facets.comp").push(push).dispatchWorkgroups(pieces.solid);
}

void makeRecord(Context& context, FacetList& list) {
  Surface& s = list.surface;
  RecordMaker record(context, "surface record", Subsystem::Facets, sizeof(SurfaceArrays));
  SurfaceArrays arrays{};
  arrays.corners = record.of(s.corners);
  if (s.pieces) {
    arrays.firstPiece = record.of(s.firstPiece);
    arrays.pieces = record.of(s.pieces);
    arrays.sides = record.of(s.sides);
    arrays.surfels = record.of(s.surfels);
    arrays.area = record.of(list.area);
    arrays.links = record.of(s.links);
  }
  s.record = record.make(arrays);
}

/// Albedo and exitance of the pieces, then of the facets, with normals. Returns how many albedos had to be clamped.
uint32_t shade(Context& context, const SceneOnDevice& scene, const Buffer& gridRecord, const Pieces& pieces,
               const Surface& surface, FacetList& list) {
  const Device& device = context.device;
  const Order order = groupByMaterial(scene, downloadAs<uint32_t>(context, surface.pieces));
  const Buffer ordered =
      makeBuffer<uint32_t>(context, "pieces by material", Subsystem::Facets, std::span<const uint32_t>(order.items));
  const Buffer clamped = words(device, "clamped albedo", 1);
  const Buffer albedo = words(device, "pieces' albedo", 3ull * pieces.count),
               emission = words(device, "pieces' exitance", list.hasEmission ? 3ull * pieces.count : 0);
  Frame frame = context.begin();
  frame.pass(kListStage).fill(clamped, 0);
  dispatchByMaterial(frame, kVoxelizeStage, "gi/piece_shade.comp", scene, order, [&](Pass& pass) {
    PieceShadePush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(gridRecord);
    push.order = pass.in(ordered);
    push.pieceVoxel = pass.in(pieces.pieceVoxel);
    push.pieces = pass.in(surface.pieces);
    push.albedo = pass.out(albedo);
    push.emission = pass.out(emission);
    push.clamped = pass.out(clamped);
    push.hasEmission = list.hasEmission;
    return push;
  });
  Pass pass = frame.pass(kVoxelizeStage);
  FacetMeanPush push{};
  push.scene = pass.in(scene.record);
  push.surface = pass.in(surface.record);
  push.voxel = pass.in(list.voxel);
  push.reverse = pass.in(list.reverse);
  push.pieceArea = pass.in(pieces.area);
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

}  // namespace

FacetList listFacets(Context& context, const SceneOnDevice& scene, const Settings& settings) {
  if (settings.voxel.method != VoxelMethod::conservative || settings.thesis.literal)
    throw UsageError("matrix.hit_rule=triangles needs voxel.method=conservative and thesis.literal=false");
  if (settings.matrix.format != MatrixFormat::csr)
    throw UsageError("matrix.hit_rule=triangles needs matrix.format=csr");
  const Device& device = context.device;
  const uint32_t triangles = scene.scene.triangleCount();
  FacetList list;
  list.grid = makeGrid(scene.scene.boundsMin, scene.scene.boundsMax, settings.voxel.resolution);
  list.encoding = settings.voxel.normals;
  list.hasEmission = keepsEmission(scene, settings);
  const Buffer grid = makeBuffer<Grid>(context, "grid", Subsystem::Voxels, std::span(&list.grid, 1));
  Surface& surface = list.surface;
  surface.corners = words(device, "triangles' corners", 9ull * triangles);
  makeRecord(context, list);
  {
    Frame frame = context.begin();
    Pass pass = frame.pass(kVoxelizeStage);
    SurfaceCornersPush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(grid);
    push.corners = pass.out(surface.corners);
    push.triangles = triangles;
    pass.shader("gi/surface_corners.comp").push(push).dispatch(triangles);
    frame.submit();
  }
  Pieces pieces = listPieces(context, scene, list.grid, grid, surface.corners);

  // How many facets each solid voxel has, and where they start.
  Buffer start = words(device, "facets of voxels", pieces.solid), total = words(device, "facets", 1);
  if (pieces.solid > 0) {
    Frame frame = context.begin();
    classify(frame, scene, grid, pieces, pieces.triangle, surface, start, nullptr);
    exclusiveScan(frame, kListStage, start, pieces.solid, total);
    frame.submitAndWait();
    list.count = downloadAs<uint32_t>(context, total).at(0);
  }
  list.solidVoxels = pieces.solid;
  allocateFacets(device, list);
  surface.pieces = std::move(pieces.triangle);
  surface.sides = words(device, "pieces' sides", pieces.count);
  surface.firstPiece = words(device, "first pieces of facets", uint64_t{list.count} + 1);
  surface.surfels = Buffer(device, "surfels", Subsystem::Facets, sizeof(Surfel) * FACET_SURFELS * uint64_t{list.count});
  surface.links = words(device, "links of facets", uint64_t{FACET_LINKS} * list.count);
  makeRecord(context, list);
  Frame frame = context.begin();
  frame.pass(kListStage).fill(list.reverse, NO_FACET);
  frame.pass(kListStage).copy(pieces.first, surface.firstPiece, 4, 4ull * pieces.solid, 4ull * list.count);
  if (pieces.solid > 0) classify(frame, scene, grid, pieces, surface.pieces, surface, start, &list);
  if (list.count > 0) {
    Pass pass = frame.pass(kListStage);
    LinkFacetsPush push{};
    push.surface = pass.in(surface.record);
    push.voxel = pass.in(list.voxel);
    push.reverse = pass.in(list.reverse);
    push.links = pass.out(surface.links);
    push.dims = list.grid.dims;
    push.count = list.count;
    pass.shader("gi/link_facets.comp").push(push).dispatch(uint64_t{FACET_LINKS} * list.count);
  }
  frame.submitAndWait();
  if (list.count > 0) list.clampedAlbedo = shade(context, scene, grid, pieces, surface, list);
  recordFacets(context, list);
  return list;
}

}  // namespace irad
