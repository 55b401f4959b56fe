// "RE Specular": one invocation per pixel. Writes the mean reflected radiance (without the lobe's reflectance) and the
// view depth; depth -1 marks pixels that traced nothing.
#include "specular/trace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D tracedTarget;

void main() {
  GpuCamera camera = push.camera.at[0];
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, camera.size))) return;
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  float depth = texelFetch(depthTarget, pixel, 0).r;
  vec4 normal = imageLoad(normalTarget, pixel);
  vec4 f0 = imageLoad(f0Target, pixel);
  vec4 traced = vec4(0.0, 0.0, 0.0, -1.0);
  if (depth < 1.0 && !tracesNothing(f0, normal.w, imageLoad(indirectTarget, pixel).rgb)) {
    Grid grid = push.grid;
    vec3 axis = viewAxis(camera);
    float z = viewDepth(camera, depth);
    vec3 local = pixelPosition(camera, pixel, z, axis);
    Surface s;
    s.position = (local - grid.origin) * grid.inverseEdge;
    s.normal = normalize(normal.xyz);
    s.face = normalize(imageLoad(geometricTarget, pixel).xyz);
    s.view = towardsViewer(camera, local, axis);
    s.f0 = f0.rgb;
    s.roughness = normal.w;
    // Shifts of neighbouring pixels follow the R2 lattice (Roberts 2018), so that any few of them cover the lobe evenly.
    uvec2 shift = uvec2(pixel.x * 3242174889u + pixel.y * 2447445414u, pixel.x * 2447445414u + pixel.y * 1847517997u);
    TraceWorld world = TraceWorld(push.facets.at[0], push.chebyshev, grid.dims, push.jfaMax);
    traced = vec4(traceLobe(world, grid, s, shift), z);
  }
  imageStore(tracedTarget, pixel, traced);
}
