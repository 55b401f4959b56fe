// specular.mode=fragment (docs/method.md 8, T 5.11).
#pragma once

namespace irad {

struct SpecularPicture;
/// Every pixel traces by itself, unfiltered, into targets.specular: in the fragment shader, or in kernels where these
/// rasterize.
void traceByPixel(SpecularPicture& picture);

}  // namespace irad
