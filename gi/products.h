// What a pipeline has made of its scene, stage by stage, and how pictures are drawn from it.
#pragma once

#include <optional>

#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/indirect.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pixel_emitters.h"
#include "gi/plan.h"
#include "gi/views/draw.h"
#include "gi/views/fields.h"

namespace irad {

/// One member per stage's product, all made from one facet list. Before the first build there are none.
struct Products {
  std::optional<FacetList> facets;
  FacetParts parts;   ///< of `facets`, since the first edit of a material
  Buffer gridRecord;  ///< one Grid
  std::optional<Field> field;
  std::optional<FormFactors> matrix;
  std::optional<Emitters> emitters;
  EmissiveTriangles emissiveTriangles;
  std::optional<Lighting> light;
  Buffer reference;  ///< H by the oracle, for its view; none where the scene does not know it
  ViewFields fields;
};

/// What the products have shown to the plan; they must have facets and emitters.
BuildTraits buildTraits(const Products& products);

/// Where shading reads H from for `view`; nothing where there is no light. `pixelEmitters`: EffectPlan's. The products
/// outlive what is drawn.
IndirectInputs indirectInputs(const Products& products, View view, bool pixelEmitters, const Settings& obeyed);

/// The products' part of what a view may draw from. They outlive what is drawn.
ViewInputs viewInputs(Products& products, bool pixelEmitters);

}  // namespace irad
