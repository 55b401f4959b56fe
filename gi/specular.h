// Reflections of the voxelized scene (docs/method.md 8).
#pragma once

namespace irad {

class Buffer;
class Frame;
struct Settings;
struct Targets;
struct ViewInputs;

/// "RE Specular" in compute over the G-buffer (docs/method.md 8): traces settings.specular.rays rays per pixel in the
/// GGX lobe through the voxels, radiance B/pi at the hit; rough surfaces take H/pi. Makes and writes
/// targets.specular; gives it back, and records nothing, where specular.mode is off or f0 or H is absent.
void traceSpecular(Frame& frame, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                   Targets& targets);

}  // namespace irad
