// The G-buffer as specular tracing and its filter read it.
#include "forward/camera_view.glsl"
#include "shared/ggx.h"
#include "shared/indirect.h"

layout(push_constant, scalar) uniform PushBlock {
  SpecularPush push;
};

float roughestTraced(vec4 f0) {
  return roughnessLimit(push.params, max(f0.r, max(f0.g, f0.b)));
}

/// Share of the traced reflection, 1 from `fade` below the roughest that is traced.
float tracedShare(vec4 f0, float roughness) {
  return clamp((roughestTraced(f0) - roughness) / max(push.params.fade, 1e-4), 0.0, 1.0);
}

/// No rays: no lobe, too rough, or too little light here to matter (docs/method.md 8). The targets hold roughness in
/// half precision, which some devices truncate: a material at max_roughness would come back below it.
bool tracesNothing(vec4 f0, float roughness, vec3 irradiance) {
  if (f0.w == 0.0 || roughness * (1.0 + 1.0 / 1024.0) >= roughestTraced(f0)) return true;
  vec3 reflected = f0.rgb * irradiance;
  return max(reflected.r, max(reflected.g, reflected.b)) < push.leastReflected;
}
