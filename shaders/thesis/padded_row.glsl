// Rows of the padded matrix (T Fig. 7): a fixed stride of places, each one hit's column and weight, in the rays' order.
// For gi/matrix_row.glsl.
uint paddedStart(MatrixArrays m, uint row) {
  return (row & ((1u << m.segmentShift) - 1u)) * m.stride;
}

RowEntry paddedEntry(Row r, uint i) {
  uvec2 place = r.places.at[r.start + i];
  return RowEntry(place.x, uintBitsToFloat(place.y), 0u);
}

uint paddedHitsOn(Row row, uint column) {
  uint hits = 0u;
  for (uint i = 0u; i < row.count; ++i) hits += uint(paddedEntry(row, i).column == column);
  return hits;
}
