#include "gi/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "gi/host_facets.h"
#include "gi/host_matrix.h"
#include "renderer/error.h"
#include "renderer/output_file.h"
#include "shaders/shared/normals.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

std::vector<glm::vec3> firstThree(const std::vector<glm::vec4>& values) {
  return {values.begin(), values.end()};
}

/// Normals of all facets, unit.
std::vector<glm::vec3> normals(Context& context, const FacetList& facets) {
  std::vector<glm::vec3> out;
  for (const uint32_t shape : downloadAs<uint32_t>(context, facets.shape)) {
    if (out.size() == facets.count) break;  // an empty list still has 16 bytes
    out.push_back(decodeNormal(shape & 0xFFFFu, static_cast<uint32_t>(facets.encoding)));
  }
  return out;
}

std::vector<glm::vec3> albedos(Context& context, const FacetList& facets) {
  std::vector<glm::vec3> out;
  for (const glm::uvec2 packed : downloadAs<glm::uvec2>(context, facets.albedo)) out.push_back(unpackAlbedo(packed));
  return out;
}

std::vector<glm::vec3> emissions(Context& context, const FacetList& facets) {
  if (!facets.hasEmission) return std::vector<glm::vec3>(facets.count, glm::vec3(0));
  return downloadAs<glm::vec3>(context, facets.emission);
}

/// One vector per voxel from one per facet. `mean`: of a voxel's facets; otherwise the first facet's.
std::vector<glm::vec3> perVoxel(Context& context, const FacetList& facets, const std::vector<glm::vec3>& values,
                                bool mean) {
  std::vector<glm::vec3> out(facets.grid.voxels, glm::vec3(0));
  const std::vector<uint32_t> reverse = downloadAs<uint32_t>(context, facets.reverse);
  for (uint32_t v = 0; v < facets.grid.voxels; ++v) {
    if (reverse[v] == NO_FACET) continue;
    const uint32_t first = reverse[v] & ~SECOND_FACET;
    const bool two = (reverse[v] & SECOND_FACET) != 0;
    IRAD_CHECK_OP(size_t{first} + (two ? 1 : 0), <, values.size());
    out[v] = two && mean ? 0.5f * (values[first] + values[first + 1]) : values[first];
  }
  return out;
}

std::span<const float> floats(const std::vector<glm::vec3>& values) {
  return {reinterpret_cast<const float*>(values.data()), values.size() * 3};
}

}  // namespace

fs::path exportVolume(Context& context, Volume volume, const FacetList& facets, const Field& field,
                      const Lighting& lighting, const fs::path& folder) {
  const fs::path path = folder / (std::string(EnumNames<Volume>::names.at(static_cast<size_t>(volume))) + ".npy");
  const glm::uvec3 dims = facets.grid.dims;
  if (volume == Volume::distance) {
    writeNpy<float>(path, {dims.z, dims.y, dims.x}, hostDistances(context, facets.grid, field));
    return path;
  }
  std::vector<glm::vec3> values;
  switch (volume) {
    case Volume::radiosity:
      values = firstThree(downloadAs<glm::vec4>(context, lighting.radiosity));
      break;
    case Volume::irradiance:
      values = firstThree(downloadAs<glm::vec4>(context, lighting.indirect));
      break;
    case Volume::albedo:
      values = albedos(context, facets);
      break;
    case Volume::emission:
      values = emissions(context, facets);
      break;
    case Volume::normal:
    case Volume::distance:
      values = normals(context, facets);
      break;
  }
  writeNpy<float>(path, {dims.z, dims.y, dims.x, 3},
                  floats(perVoxel(context, facets, values, /*mean=*/volume != Volume::normal)));
  return path;
}

std::vector<fs::path> exportMatrix(Context& context, const FormFactors& matrix, const fs::path& folder) {
  // Merged sizes first: a padded row counts its hits, not its distinct columns.
  std::vector<int64_t> indptr{0};
  forEachRow(context, matrix, [&](uint32_t, const HostRow& row) {
    indptr.push_back(indptr.back() + static_cast<int64_t>(merged(row).columns.size()));
  });
  const auto entries = static_cast<uint64_t>(indptr.back());
  NpyFile<int32_t> indices(folder / "indices.npy", {entries});
  NpyFile<float> data(folder / "data.npy", {entries});
  forEachRow(context, matrix, [&](uint32_t, const HostRow& stored) {
    const HostRow row = merged(stored);
    std::vector<float> weights;
    for (const uint32_t hits : row.hits) weights.push_back(static_cast<float>(hits) * row.weight);
    indices.write(std::vector<int32_t>(row.columns.begin(), row.columns.end()));
    data.write(weights);
  });
  writeNpy<int64_t>(folder / "indptr.npy", {indptr.size()}, indptr);
  indices.commit();
  data.commit();
  return {folder / "indptr.npy", folder / "indices.npy", folder / "data.npy"};
}

std::vector<fs::path> exportFacets(Context& context, const FacetList& facets, const Lighting& lighting,
                                   const fs::path& folder) {
  std::vector<fs::path> files;
  const uint64_t count = facets.count;
  const auto write = [&](const char* name, std::vector<glm::vec3> values) {
    values.resize(count);  // an empty list still has 16 bytes
    files.push_back(folder / fmt::format("facet_{}.npy", name));
    writeNpy<float>(files.back(), {count, 3}, floats(values));
  };
  std::vector<int32_t> voxels;
  std::vector<glm::vec3> positions;
  for (const uint32_t packed : downloadAs<uint32_t>(context, facets.voxel)) {
    if (positions.size() == count) break;
    const glm::uvec3 v = unpackVoxel(packed);
    voxels.insert(voxels.end(), {static_cast<int32_t>(v.x), static_cast<int32_t>(v.y), static_cast<int32_t>(v.z)});
    positions.push_back(facets.grid.origin + (glm::vec3(v) + 0.5f) * facets.grid.edge);
  }
  files.push_back(folder / "facet_voxel.npy");
  writeNpy<int32_t>(files.back(), {count, 3}, voxels);
  write("position", positions);
  write("normal", normals(context, facets));
  write("albedo", albedos(context, facets));
  write("emission", emissions(context, facets));
  write("direct", firstThree(downloadAs<glm::vec4>(context, lighting.direct)));
  write("irradiance", firstThree(downloadAs<glm::vec4>(context, lighting.indirect)));
  write("radiosity", firstThree(downloadAs<glm::vec4>(context, lighting.radiosity)));
  return files;
}

}  // namespace irad
