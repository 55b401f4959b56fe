#include "gi/products.h"

namespace irad {

BuildTraits buildTraits(const Products& p) {
  const MatrixStats stats = p.matrix ? p.matrix->stats : MatrixStats{};
  return {.voxels = p.facets->grid.voxels,
          .facets = p.facets->count,
          .emitters = p.emitters->count,
          .sampledShare = p.light ? p.light->sampledShare : 0,
          .sampled = p.light && p.light->correction,
          .matrix = p.matrix && *p.matrix,
          .escaped = stats.rays > 0 ? static_cast<double>(stats.escaped) / static_cast<double>(stats.rays) : 0,
          .sky = p.matrix && p.matrix->rowSky};
}

IndirectInputs indirectInputs(const Products& p, View view, bool pixelEmitters, const Settings& obeyed) {
  IndirectInputs in;
  if (!p.facets || p.facets->count == 0 || !p.light || !*p.light) return in;
  in.grid = &p.gridRecord;
  in.facets = &*p.facets;
  in.field = &*p.field;
  in.direct = &p.light->direct;
  in.shaded = &p.light->shaded();
  in.keepFacet = obeyed.writeback.mode != WritebackMode::off;
  in.keepPosition = pixelEmitters && p.light->emitted;
  const ViewInfo* info = viewInfo(view);
  if (((info != nullptr && info->isFrom(FROM_EMITTED)) || in.keepPosition) && p.light->emitted)
    in.shadedEmitted = &p.light->shadedEmitted();
  in.volume = p.light->volume ? &p.light->volume.image : nullptr;
  in.sample = obeyed.sample.gpu;
  return in;
}

ViewInputs viewInputs(Products& p, bool pixelEmitters) {
  ViewInputs inputs;
  if (p.facets) inputs.facets = &*p.facets;
  if (p.field) inputs.field = &*p.field;
  if (p.matrix && *p.matrix) inputs.matrix = &*p.matrix;
  if (p.light && *p.light) {
    inputs.lighting = &*p.light;
    inputs.written = &p.light->writeback;
  }
  if (p.emitters) inputs.emitters = &*p.emitters;
  if (pixelEmitters) inputs.emissiveTriangles = &p.emissiveTriangles;
  if (p.reference) inputs.reference = &p.reference;
  inputs.fields = &p.fields;
  return inputs;
}

}  // namespace irad
