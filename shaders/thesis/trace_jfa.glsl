// T 5.2: rays that step over spheres of the distance that jump flooding has stored. The value has 8 bits and is a
// distance between cell centres, so rays tunnel and end elsewhere; docs/method.md 3 gives the figures. This is the
// thesis's behaviour. For gi/trace.glsl.
layout(set = 0, binding = TRACE_JFA_BINDING) uniform sampler3D jfaDistance;

/// Walks to the next solid cell, the present one included. False: left the grid.
bool traceToSolid(TraceWorld world, inout TraceWalk w, inout uint steps) {
  while (traceInside(w, world.dims)) {
    float d = texelFetch(jfaDistance, ivec3(w.cell), 0).r * world.jfaMax;
    if (d <= 0.0f) return true;
    ++steps;
    w.t += d;
    w.cell = floor(w.origin + w.t * w.direction);
  }
  return false;
}
