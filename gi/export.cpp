#include "gi/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/host_matrix.h"
#include "gi/lighting.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/frame/transfer.h"
#include "shaders/shared/normals.h"

namespace irad {
namespace fs = std::filesystem;
namespace {

/// Normals of all facets, unit.
std::vector<glm::vec3> normals(Context& context, const FacetList& facets) {
  std::vector<glm::vec3> out;
  for (const uint32_t shape : downloadAs<uint32_t>(context, facets.shape)) {
    if (out.size() == facets.count) break;  // an empty list still has 16 bytes
    out.push_back(decodeNormal(shape & 0xFFFFu, facets.encoding));
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
    const uint32_t first = firstFacet(reverse[v]), facets = mean ? facetsOf(reverse[v]) : 1;
    IRAD_CHECK_OP(size_t{first} + facets, <=, values.size());
    for (uint32_t i = first; i < first + facets; ++i) out[v] += values[i];
    out[v] /= static_cast<float>(facets);
  }
  return out;
}

std::span<const float> floats(const std::vector<glm::vec3>& values) {
  return {reinterpret_cast<const float*>(values.data()), values.size() * 3};
}

}  // namespace

VolumeValues readVolume(Context& context, Volume volume, const FacetList& facets, const Field& field,
                        const Lighting& lighting) {
  VolumeValues out{.volume = volume, .grid = facets.grid, .channels = 3};
  for (const uint32_t facet : downloadAs<uint32_t>(context, facets.reverse)) {
    if (out.solid.size() == facets.grid.voxels) break;  // buffers may be longer than what they hold
    out.solid.push_back(facet != NO_FACET);
  }
  std::vector<glm::vec3> values;
  switch (volume) {
    case Volume::distance:
      out.channels = 1;
      out.values = hostDistances(context, facets.grid, field);
      return out;
    case Volume::radiosity:
      values = perFacet(context, facets, lighting.radiosity);
      break;
    case Volume::irradiance:
      values = perFacet(context, facets, lighting.indirect);
      break;
    case Volume::albedo:
      values = albedos(context, facets);
      break;
    case Volume::emission:
      values = emissions(context, facets);
      break;
    case Volume::normal:
      values = normals(context, facets);
      break;
  }
  const std::vector<glm::vec3> voxels = perVoxel(context, facets, values, /*mean=*/volume != Volume::normal);
  out.values.assign(floats(voxels).begin(), floats(voxels).end());
  return out;
}

fs::path writeVolumeNpy(const VolumeValues& volume, const fs::path& folder) {
  const fs::path path = folder / fmt::format("{}.npy", nameOf(volume.volume));
  std::vector<uint64_t> shape{volume.grid.dims.z, volume.grid.dims.y, volume.grid.dims.x};
  if (volume.channels > 1) shape.push_back(volume.channels);
  writeNpy<float>(path, shape, volume.values);
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

FacetTable readFacets(Context& context, const FacetList& facets, const Lighting& lighting) {
  FacetTable table;
  std::vector<glm::vec3> positions;
  for (const uint32_t packed : downloadAs<uint32_t>(context, facets.voxel)) {
    if (positions.size() == facets.count) break;
    const glm::uvec3 v = unpackVoxel(packed);
    table.voxel.emplace_back(v);
    positions.push_back(facets.grid.origin + (glm::vec3(v) + 0.5f) * facets.grid.edge);
  }
  const auto add = [&](const char* name, std::vector<glm::vec3> values) {
    values.resize(facets.count);  // an empty list still has 16 bytes
    table.attributes.emplace_back(name, std::move(values));
  };
  add("position", std::move(positions));
  add("normal", normals(context, facets));
  add("albedo", albedos(context, facets));
  add("emission", emissions(context, facets));
  add("direct", perFacet(context, facets, lighting.direct));
  add("irradiance", perFacet(context, facets, lighting.indirect));
  add("radiosity", perFacet(context, facets, lighting.radiosity));
  if (const Buffer& reflected = lighting.writeback.used) add("reflected", perFacet(context, facets, reflected));
  return table;
}

std::vector<fs::path> writeFacetsNpy(const FacetTable& facets, const fs::path& folder) {
  const uint64_t count = facets.voxel.size();
  std::vector<fs::path> files{folder / "facet_voxel.npy"};
  writeNpy<int32_t>(files.back(), {count, 3}, {reinterpret_cast<const int32_t*>(facets.voxel.data()), count * 3});
  for (const auto& [name, values] : facets.attributes) {
    files.push_back(folder / fmt::format("facet_{}.npy", name));
    writeNpy<float>(files.back(), {count, 3}, floats(values));
  }
  return files;
}

fs::path writeFacetsCsv(const FacetTable& facets, const fs::path& folder) {
  const fs::path path = folder / "facets.csv";
  OutputFile file(path);
  std::string line = "voxel_x,voxel_y,voxel_z";
  for (const auto& [name, values] : facets.attributes) line += fmt::format(",{0}_x,{0}_y,{0}_z", name);
  file.write(line + "\n");
  for (size_t i = 0; i < facets.voxel.size(); ++i) {
    const glm::ivec3 v = facets.voxel[i];
    line = fmt::format("{},{},{}", v.x, v.y, v.z);
    for (const auto& [name, values] : facets.attributes)
      line += fmt::format(",{},{},{}", values[i].x, values[i].y, values[i].z);
    file.write(line + "\n");
  }
  file.commit();
  return path;
}

}  // namespace irad
