// A scene lit by the whole method, stage by stage, without its pipeline.
#pragma once

#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/gather.h"
#include "gi/gather_emitters.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/scatter.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "gi/views/draw.h"
#include "gi/views/fields.h"
#include "tests/forward_support.h"

namespace irad::test {

/// A scene's facets and the light on them, and pictures of it.
struct Lit {
  Stage stage;
  FacetList facets;
  Field field;
  FormFactors matrix;
  Lighting light;
  Emitters emitters;
  Buffer grid;
  ViewFields fields;
  Image picture;  ///< to compare with
  Lit(Context& context, Scene scene, Settings settings) : stage(context, std::move(scene), settings) {
    facets = makeFacets(context, stage.device, settings);
    field = buildField(context, facets, settings);
    matrix = buildMatrix(context, facets, field, settings);
    light = makeLighting(context, facets, settings);
    emitters = listEmitters(context, facets);
    Frame direct = context.begin();
    gather(direct, stage.device, stage.shadows, facets, field, light, settings);
    direct.submitAndWait();
    gatherEmitters(context, facets, matrix, {}, settings, light);
    solve(context, facets, matrix, light, settings, settings.solver.maxSweeps);
    Frame frame = context.begin();
    scatter(frame, facets, matrix, light, settings);
    frame.submitAndWait();
    grid = makeBuffer(context, "grid", Subsystem::Voxels, std::span<const Grid>(&facets.grid, 1));
  }
  ViewInputs inputs() {
    return {.scene = &stage.device,
            .facets = &facets,
            .field = &field,
            .matrix = &matrix,
            .lighting = &light,
            .emitters = &emitters,
            .shadows = &stage.shadows,
            .picture = picture ? &picture : nullptr,
            .fields = &fields};
  }
  IndirectInputs indirect() const {
    IndirectInputs in;
    in.grid = &grid;
    in.facets = &facets;
    in.field = &field;
    in.direct = &light.direct;
    in.shaded = &light.shaded();
    if (light.emitted) in.shadedEmitted = &light.shadedEmitted();
    in.volume = light.volume ? &light.volume.image : nullptr;
    in.sample = stage.settings.sample.gpu;
    return in;
  }
  Picture draw(View view, glm::uvec2 size = {64, 64}, const ForwardEffects& effects = {}) {
    return stage.draw(view, size, 0, inputs(), indirect(), effects);
  }
};

}  // namespace irad::test
