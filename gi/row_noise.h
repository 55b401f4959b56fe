// What finitely many rays leave unknown of H (docs/method.md 7).
#pragma once

namespace irad {

class Buffer;
class Frame;
struct FacetList;
struct FormFactors;
struct Lighting;
struct SolverSettings;

/// `error` becomes the standard error of H by each row's rays, as the length of xyz (W/m^2, over the three channels
/// together), for the light as it is in B and H. One product with the matrix. `squares` and light.radiosityNext are
/// overwritten; `error` may be the latter. 16 bytes a facet each.
void rowNoise(Frame& frame, const FacetList& facets, const FormFactors& matrix, const SolverSettings& settings,
              const Lighting& light, const Buffer& squares, const Buffer& error);

}  // namespace irad
