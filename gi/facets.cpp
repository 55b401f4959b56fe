// The facet list (docs/method.md 4, T 5.3): Morton-ordered compaction, attributes, reverse map.
#include "gi/facets.h"

#include <algorithm>
#include <vector>

#include "gi/group_by_material.h"
#include "gi/scan.h"
#include "gi/scene_shape.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/voxel_pass.h"
#include "gi/voxelize.h"
#include "renderer/base/error.h"
#include "renderer/frame/record.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/energy.h"
#include "shaders/shared/voxelize.h"

namespace irad {
namespace {

constexpr const char* kFacetsStage = "GI CompactList";

/// Attributes of all facets. `stage`: whose time it is; in the thesis the voxelizer's, which writes them. Returns how
/// many albedos had to be clamped.
uint32_t shadeFacets(Context& context, const char* stage, const SceneOnDevice& scene, const Buffer& gridRecord,
                     const FacetList& list, const Settings& settings) {
  const Order order = groupByMaterial(scene, downloadAs<uint32_t>(context, list.triangle));
  const Buffer facets =
      makeBuffer<uint32_t>(context, "facets by material", Subsystem::Facets, std::span<const uint32_t>(order.items));
  const Buffer clamped(context.device, "clamped albedo", Subsystem::Facets, 4);
  const bool raster = settings.voxel.method == VoxelMethod::raster;
  Frame frame = context.begin();
  frame.pass(stage).fill(clamped, 0);
  const char* shader = raster ? "thesis/facet_shade_raster.comp" : "gi/facet_shade.comp";
  dispatchByMaterial(frame, stage, shader, scene, order, [&](Pass& pass) {
    ShadeFacetsPush push{};
    push.scene = pass.in(scene.record);
    push.grid = pass.in(gridRecord);
    push.order = pass.in(facets);
    push.voxel = pass.in(list.voxel);
    push.triangle = pass.in(list.triangle);
    push.shape = pass.out(list.shape);
    push.albedo = pass.out(list.albedo);
    push.emission = pass.out(list.emission);
    push.area = pass.out(list.area);
    push.clamped = pass.out(clamped);
    push.encoding = list.encoding;
    push.hasEmission = list.hasEmission;
    push.literal = settings.thesis.literal;
    return push;
  });
  frame.submitAndWait();
  return downloadAs<uint32_t>(context, clamped).at(0);
}

Buffer emissionBuffer(const Device& device, uint32_t count, bool kept) {
  return Buffer(device, "facet emission", Subsystem::Facets, kept ? 12ull * count : 0);
}

}  // namespace

bool keepsEmission(const SceneOnDevice& scene, const Settings& settings) {
  const EffectMode mode = settings.effects.emission;
  return mode == EffectMode::automatic ? scene.anyEmission : mode == EffectMode::on;
}

void allocateFacets(const Device& device, FacetList& list) {
  if (list.count > MAX_FACETS)
    throw WorkError(fmt::format("{} facets; the list holds at most {}", list.count, MAX_FACETS));
  const uint64_t n = list.count;
  list.voxel = Buffer(device, "facet voxel", Subsystem::Facets, 4 * n);
  list.shape = Buffer(device, "facet shape", Subsystem::Facets, 4 * n);
  list.albedo = Buffer(device, "facet albedo", Subsystem::Facets, 8 * n);
  list.emission = emissionBuffer(device, list.count, list.hasEmission);
  list.area = Buffer(device, "facet areas", Subsystem::Facets, 4 * n);
  list.reverse = Buffer(device, "facet reverse map", Subsystem::Facets, 4ull * list.grid.voxels);
}

void recordFacets(Context& context, FacetList& list) {
  RecordMaker record(context, "facet record", Subsystem::Facets, sizeof(FacetArrays));
  list.record = record.make(list.arrays([&](const Buffer& buffer) { return record.of(buffer); }));
}

FacetArrays FacetList::arrays(const std::function<uint64_t(const Buffer&)>& addressOf) const {
  FacetArrays arrays{};
  arrays.voxel = addressOf(voxel);
  arrays.shape = addressOf(shape);
  arrays.albedo = addressOf(albedo);
  arrays.emission = addressOf(emission);
  arrays.reverse = addressOf(reverse);
  arrays.count = count;
  arrays.hasEmission = hasEmission;
  return arrays;
}

FacetList makeFacets(Context& context, const SceneOnDevice& scene, const SceneShape& shape, const Settings& settings,
                     const std::function<void()>& watch) {
  requireMatching(settings);
  if (settings.matrix.gpu.hitRule == HitRule::triangles)
    return listFacets(context, scene, shape, settings, listsFaster(context.device), watch);
  Voxels voxels = voxelize(context, scene, settings);
  if (watch) watch();
  return compactFacets(context, voxels, settings);
}

FacetList makeFacets(Context& context, const SceneOnDevice& scene, const Settings& settings) {
  return makeFacets(context, scene, shapeOf(scene.scene, settings), settings);
}

void shadeAnew(Context& context, const SceneOnDevice& scene, const Buffer& gridRecord, const Settings& settings,
               FacetList& list, const FacetParts& parts) {
  const bool emission = keepsEmission(scene, settings);
  constexpr const char* kStage = "GI Materials";
  shadeOuter(context, scene, list.outer);
  if (emission != list.hasEmission) {
    list.emission = emissionBuffer(context.device, list.count, emission);
    list.hasEmission = emission;
    recordFacets(context, list);
  }
  if (list.count == 0) return;
  list.clampedAlbedo = list.surface
                           ? shadeParts(context, kStage, scene, gridRecord, parts, list, listsFaster(context.device))
                           : shadeFacets(context, kStage, scene, gridRecord, list, settings);
}

FacetList compactFacets(Context& context, Voxels& voxels, const Settings& settings) {
  FacetList list;
  list.grid = voxels.grid;
  list.encoding = settings.voxel.normals;
  list.hasEmission = keepsEmission(*voxels.scene, settings);
  const uint32_t bits = voxels.grid.mortonBits.x + voxels.grid.mortonBits.y + voxels.grid.mortonBits.z;
  CompactPush push{};
  push.blocks = 1u << (bits - 6);

  // Facets per block of 64 voxels, and where each block's facets start.
  Buffer blocks(context.device, "block counts", Subsystem::Facets, 4ull * push.blocks);
  Buffer total(context.device, "facet total", Subsystem::Facets, 4);
  {
    Frame frame = context.begin();
    Pass pass = frame.pass(kFacetsStage);
    push.grid = pass.in(voxels.gridRecord);
    push.keys = pass.in(voxels.keys);
    push.blockCounts = pass.out(blocks);
    pass.shader("gi/facet_count.comp").push(push).dispatch(push.blocks);
    exclusiveScan(frame, kFacetsStage, blocks, push.blocks, total);
    frame.submitAndWait();
  }
  list.count = list.solidVoxels = downloadAs<uint32_t>(context, total).at(0);

  allocateFacets(context.device, list);
  list.triangle = Buffer(context.device, "facet triangles", Subsystem::Facets, 4ull * list.count);
  Frame frame = context.begin();
  Pass pass = frame.pass(kFacetsStage);
  push.grid = pass.in(voxels.gridRecord);
  push.keys = pass.in(voxels.keys);
  push.blockCounts = pass.in(blocks);
  push.voxel = pass.out(list.voxel);
  push.triangle = pass.out(list.triangle);
  push.reverse = pass.out(list.reverse);
  pass.shader("gi/facet_emit.comp").push(push).dispatch(push.blocks);
  frame.submitAndWait();
  if (list.count > 0)
    list.clampedAlbedo = shadeFacets(context, kVoxelizeStage, *voxels.scene, voxels.gridRecord, list, settings);
  recordFacets(context, list);
  voxels.keys = Buffer();
  return list;
}

FacetList uploadFacets(Context& context, const Grid& grid, const std::vector<uint32_t>& voxel,
                       const std::vector<uint32_t>& shape, const std::vector<glm::uvec2>& albedo,
                       const std::vector<glm::vec3>& emission, NormalEncoding encoding) {
  IRAD_CHECK_OP(voxel.size(), ==, shape.size());
  IRAD_CHECK_OP(voxel.size(), ==, albedo.size());
  IRAD_CHECK(emission.empty() || emission.size() == voxel.size(), "{} emissions for {} facets", emission.size(),
             voxel.size());
  FacetList list;
  list.grid = grid;
  list.count = static_cast<uint32_t>(voxel.size());
  list.encoding = encoding;
  list.hasEmission =
      std::any_of(emission.begin(), emission.end(), [](const glm::vec3& e) { return e != glm::vec3(0); });
  std::vector<uint32_t> reverse(grid.voxels, NO_FACET);
  for (uint32_t i = 0; i < list.count; ++i) {
    const uvec3 v = unpackVoxel(voxel[i]);
    IRAD_CHECK(glm::all(glm::lessThan(v, grid.dims)), "facet {} lies in voxel ({}, {}, {}), outside the grid", i, v.x,
               v.y, v.z);
    uint32_t& entry = reverse[voxelIndex(v, grid.dims)];
    if (entry == NO_FACET) {
      entry = facetEntryOf(i, 1);
      ++list.solidVoxels;
    } else {
      const uint32_t facets = facetsOf(entry);
      IRAD_CHECK(firstFacet(entry) + facets == i, "facets of one voxel are neighbours (facet {})", i);
      entry = facetEntryOf(firstFacet(entry), facets + 1);
    }
  }
  const auto make = [&context]<class T>(const char* name, const std::vector<T>& values) {
    return makeBuffer<T>(context, name, Subsystem::Facets, std::span<const T>(values));
  };
  list.voxel = make("facet voxel", voxel);
  list.shape = make("facet shape", shape);
  list.albedo = make("facet albedo", albedo);
  list.emission = make("facet emission", list.hasEmission ? emission : std::vector<glm::vec3>{});
  list.reverse = make("facet reverse map", reverse);
  std::vector<float> area;
  for (const uint32_t s : shape) area.push_back(facetArea(decodeNormal(s & 0xFFFFu, encoding), facetOffset(s)));
  list.area = make("facet areas", area);
  recordFacets(context, list);
  return list;
}

}  // namespace irad
