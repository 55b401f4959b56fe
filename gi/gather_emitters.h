// The first gather: light that reaches the facets straight from emissive ones.
#pragma once

namespace irad {

class Context;
struct Emitters;
struct FacetList;
struct Field;
struct FormFactors;
struct Lighting;
struct Settings;

/// F M by samples of the emitters in place of rays; empty: by rays.
struct EmitterSource {
  const Emitters* emitters = nullptr;
  const Field* field = nullptr;
  bool onHost = true;  ///< on CPU devices the host traces the samples, where this build can
};
/// `emitted`, with `correction` and `sampledShare` where the emitters are sampled. Before solve(), and again where the
/// matrix or the emission has changed. Blocking.
void gatherEmitters(Context& context, const FacetList& facets, const FormFactors& matrix, const EmitterSource& source,
                    const Settings& settings, Lighting& light);

}  // namespace irad
