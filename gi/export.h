// Exports for numpy: volumes, the form-factor matrix as the CSR triple of scipy.sparse, facets as one array per
// attribute.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gi/stages.h"
#include "renderer/frame.h"

namespace irad {

enum class Volume : uint32_t { radiosity, irradiance, albedo, normal, emission, distance };
template <>
struct EnumNames<Volume> {
  static constexpr std::array names{"radiosity", "irradiance", "albedo", "normal", "emission", "distance"};
};

/// NAME.npy, float32, indexed [z, y, x] (distance) or [z, y, x, channel]; the padding voxels are part of it. Where a
/// voxel holds two facets: their mean; of normals, the first facet's. Voxels without a facet hold 0. radiosity: B,
/// W/m^2; irradiance: H, W/m^2; emission: M, W/m^2; albedo: rho; normal: unit; distance: voxels to the nearest solid
/// voxel in the metric of field.method. Returns the file's path.
std::filesystem::path exportVolume(Context& context, Volume volume, const FacetList& facets, const Field& field,
                                   const Lighting& lighting, const std::filesystem::path& folder);

/// indptr.npy (int64, rows + 1), indices.npy (int32, ascending in each row), data.npy (float32, F_ij): what
/// scipy.sparse.csr_matrix((data, indices, indptr), shape=(rows, rows)) takes. Hits of a padded row on the same column
/// are added up.
std::vector<std::filesystem::path> exportMatrix(Context& context, const FormFactors& matrix,
                                                const std::filesystem::path& folder);

/// facet_NAME.npy, one row per facet in matrix order: voxel (int32 x, y, z), position (voxel centre, metres in world
/// axes relative to the scene's origin), normal, albedo, emission, direct, irradiance, radiosity (float32 x 3).
std::vector<std::filesystem::path> exportFacets(Context& context, const FacetList& facets, const Lighting& lighting,
                                                const std::filesystem::path& folder);

}  // namespace irad
