// What the builds of either matrix format share (gi/matrix.cpp, gi/thesis/padded_rows.cpp).
#pragma once

#include "gi/matrix.h"
#include "shaders/shared/matrix_build.h"

namespace irad {

inline constexpr const char* kMatrixStage = "GI BuildMatrix";

/// Rays in one submission: short enough for watchdogs (and for cancelling), long enough to hide the round trip.
uint64_t raysPerSubmission(const Device& device);
/// WorkError where `progress` cancels.
void reportRows(const std::function<bool(float)>& progress, uint64_t done, uint64_t all);
void addSums(MatrixStats& stats, const ChunkCounts& sums);
/// matrix.record, from `arrays` and the matrix's buffers.
void writeMatrixRecord(Context& context, FormFactors& matrix, const MatrixArrays& arrays);

}  // namespace irad
