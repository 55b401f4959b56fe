// What shading samples, from the light of the facets.
#pragma once

namespace irad {

class Frame;
struct FacetList;
struct FormFactors;
struct Lighting;
struct Settings;

/// `blurred` and `blurredEmitted`, with report.blurChange; and the volume where it exists (gi/thesis/volume.h). `light`
/// must stay where it is until the frame has finished: light.report.blurChange is read back. `watchBlur`: blurChange
/// also where the settings have no blur, without the copies.
void scatter(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings, const FormFactors* matrix, bool watchBlur = false);

}  // namespace irad
