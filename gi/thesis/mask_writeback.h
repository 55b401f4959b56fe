// writeback.mode=mask (docs/method.md 8, T 5.12).
#pragma once

namespace irad {

struct WritebackPicture;
/// Every pixel that the mask selects stores the reflection that it shows at its facet's texel of Writeback::stored:
/// from the fragment shader, or from kernels where these rasterize.
void storeSelected(const WritebackPicture& picture);

}  // namespace irad
