// Byte access to the Chebyshev field while it is being built (when finished, it is read in words of four bytes).
#include "shared/voxelize.h"
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ByteArray { uint8_t at[]; };
