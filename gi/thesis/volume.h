// The volume of light that ungated lookups sample, the thesis's RadianceTexture (docs/method.md 7, T 5.9).
#pragma once

#include "renderer/resources.h"

namespace irad {

class Context;
class Frame;
struct FacetList;
struct Grid;
struct Lighting;
struct Settings;

struct RadianceVolume {
  Image image;     ///< RGBA16F
  Buffer clamped;  ///< counter of voxels whose light exceeds what it holds
  explicit operator bool() const { return static_cast<bool>(image); }
};
RadianceVolume makeVolume(Context& context, const Grid& grid);
/// Fills light.volume: H, or B with ungated sampling (T 5.9), or B - gain (M + rho D) with edge removal (T eq. 23),
/// W/m^2 in all cases, the first facet of a voxel, alpha 1. `light` must stay where it is until the frame has finished:
/// light.report.clampedVoxels is read back.
void scatterVolume(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings);

}  // namespace irad
