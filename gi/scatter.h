// What shading samples, from the light of the facets.
#pragma once

namespace irad {

class Frame;
struct FacetList;
struct FormFactors;
struct Lighting;
struct Settings;

/// `blurred` and `blurredEmitted`, with report.blurChange; and the volume where it exists (gi/thesis/volume.h). The
/// blur goes as far as the noise of `matrix`'s rays, or by brute force the frames' spread, calls for; where neither is
/// there (no rows, less than two frames), all the way. light.radiosityNext is overwritten. `light` must stay where it
/// is until the frame has finished: light.report.blurChange is read back. `watchBlur`: blurChange also where the
/// settings have no blur, without the copies.
void scatter(Frame& frame, const FacetList& facets, const FormFactors& matrix, Lighting& light,
             const Settings& settings, bool watchBlur = false);

}  // namespace irad
