// The matrix as the thesis keeps it.
#pragma once

#include <functional>

#include "shaders/shared/gi_params.h"

namespace irad {

class Context;
struct FacetList;
struct Field;
struct FormFactors;

/// matrix.format=padded (T Fig. 7, T 5.4-5.6): a fixed stride of `rays` places of 8 bytes per row, for a power of two
/// of rows, cleared, then filled by one invocation per row. `matrix` has its rows and rowInfo; there is at least one
/// row.
void buildPaddedRows(Context& context, const FacetList& facets, const Field& field, const MatrixParams& params,
                     FormFactors& matrix, const std::function<bool(float)>& progress);

}  // namespace irad
