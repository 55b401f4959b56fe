// Hit rule `thesis` (T 5.6): the first cell with a front face (d . n < 0) ends the ray, back faces let it through. For
// gi/trace.glsl.
TraceHit traceThesis(TraceWorld world, TraceWalk w) {
  TraceHit hit = TraceHit(TRACE_ESCAPED, 0.0f, 0u);
  while (traceToSolid(world, w, hit.steps)) {
    uint facet = firstFacet(world.facets.reverse.at[traceIndex(w.cell, world.dims)]);  // a voxel has one
    float slope = dot(decodeNormal(world.facets.shape.at[facet] & 0xFFFFu, TRACE_NORMALS), w.direction);
    if (slope < 0.0f) {
      hit.facet = facet;
      hit.t = w.t;
      break;
    }
    traceAdvance(w, 1.0f);
    ++hit.steps;
  }
  return hit;
}
