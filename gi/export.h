// Exports: volumes for numpy and OpenVDB, the form-factor matrix as the CSR triple of scipy.sparse, facets as arrays
// and as a table.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shaders/shared/enumeration.h"
#include "shaders/shared/grid.h"

namespace irad {

class Context;
struct FacetList;
struct Field;
struct FormFactors;
struct Lighting;

// clang-format off
#define IRAD_VOLUMES(X) \
  X(radiosity, "radiosity") X(irradiance, "irradiance") X(albedo, "albedo") X(normal, "normal") \
  X(emission, "emission") X(distance, "distance")
// clang-format on
IRAD_ENUM(Volume, IRAD_VOLUMES)

/// A volume in host memory; the padding voxels are part of it. radiosity: B, W/m^2; irradiance: H, W/m^2; emission: M,
/// W/m^2; albedo: rho; normal: unit; distance: voxels to the nearest solid voxel in the metric of field.method.
struct VolumeValues {
  Volume volume;
  Grid grid;
  uint32_t channels;  ///< 3; distance: 1
  /// [z][y][x][channel]. Where a voxel holds two facets: their mean; of normals, the first facet's. Voxels without a
  /// facet hold 0.
  std::vector<float> values;
  std::vector<bool> solid;  ///< [z][y][x]: holds a facet
};
VolumeValues readVolume(Context& context, Volume volume, const FacetList& facets, const Field& field,
                        const Lighting& lighting);
/// NAME.npy, float32, indexed [z, y, x] or [z, y, x, channel]. Returns the file's path.
std::filesystem::path writeVolumeNpy(const VolumeValues& volume, const std::filesystem::path& folder);
/// NAME.vdb, for Blender, ParaView, Houdini: one grid NAME of float or vec3s, background 0. Its index space has voxel
/// centres at whole numbers, its world space is the scene's: metres, glTF's axes (y up), `sceneOrigin` added. Active
/// are the solid voxels; of the distance all. Metadata: unit. The same values give the same bytes. Throws in builds
/// that cannot.
std::filesystem::path writeVolumeVdb(const VolumeValues& volume, glm::dvec3 sceneOrigin,
                                     const std::filesystem::path& folder);
/// Whether this build has OpenVDB (IRAD_VDB).
bool canWriteVdb();

/// indptr.npy (int64, rows + 1), indices.npy (int32, ascending in each row), data.npy (float32, F_ij): what
/// scipy.sparse.csr_matrix((data, indices, indptr), shape=(rows, rows)) takes. Hits of a padded row on the same column
/// are added up.
std::vector<std::filesystem::path> exportMatrix(Context& context, const FormFactors& matrix,
                                                const std::filesystem::path& folder);

/// The facets in matrix order. Attributes: position (voxel centre, metres in world axes relative to the scene's
/// origin), normal, albedo, emission, direct, irradiance, radiosity.
struct FacetTable {
  std::vector<glm::ivec3> voxel;
  std::vector<std::pair<const char*, std::vector<glm::vec3>>> attributes;
};
FacetTable readFacets(Context& context, const FacetList& facets, const Lighting& lighting);
/// facet_NAME.npy, one row per facet: voxel (int32 x, y, z), and each attribute (float32 x 3).
std::vector<std::filesystem::path> writeFacetsNpy(const FacetTable& facets, const std::filesystem::path& folder);
/// facets.csv, one line per facet: voxel_x, voxel_y, voxel_z, position_x, ... Numbers keep their bits.
std::filesystem::path writeFacetsCsv(const FacetTable& facets, const std::filesystem::path& folder);

}  // namespace irad
