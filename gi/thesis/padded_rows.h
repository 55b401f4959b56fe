// The matrix as the thesis keeps it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "shaders/shared/gi_params.h"

namespace irad {

class Context;
struct FacetList;
struct Field;
struct FormFactors;
struct HostRow;
struct MatrixArrays;

/// matrix.format=padded (T Fig. 7, T 5.4-5.6): a fixed stride of `rays` places of 8 bytes per row, for a power of two
/// of rows, cleared, then filled by one invocation per row. `matrix` has its rows and rowInfo; there is at least one
/// row.
void buildPaddedRows(Context& context, const FacetList& facets, const Field& field, const MatrixParams& params,
                     FormFactors& matrix, const std::function<bool(float)>& progress);

/// What its segments take, bytes.
uint64_t paddedBytes(uint64_t rows, uint64_t rays);

// In host memory (gi/host_matrix.cpp).
inline constexpr size_t kPaddedWords = 2;  ///< of a place: column, weight
/// Where a row begins within its segment, words.
size_t paddedStart(const MatrixArrays& arrays, uint32_t row);
/// Adds the columns and hits of a row's words.
void decodePadded(std::span<const uint32_t> words, HostRow& row);

}  // namespace irad
