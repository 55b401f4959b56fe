// Whether panes tint what passes them: without, rays and rows have no code for it.
#ifndef IRAD_TINTED_GLSL
#define IRAD_TINTED_GLSL
#include "shared/constants.h"

layout(constant_id = CONSTANT_TINTED) const bool TINTED = false;

#endif
