#include "gi/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

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

std::vector<float> distances(Context& context, const FacetList& facets, const Field& field) {
  std::vector<float> out;
  out.reserve(facets.grid.voxels);
  const bool jfa = field.method == FieldMethod::jfa;
  const std::vector<std::byte> bytes = jfa ? download(context, field.jfaDistance) : download(context, field.chebyshev);
  IRAD_CHECK_OP(bytes.size(), >=, facets.grid.voxels);
  for (uint32_t v = 0; v < facets.grid.voxels; ++v) {
    const float value = static_cast<float>(std::to_integer<uint32_t>(bytes[v]));
    out.push_back(jfa ? value / 255.0f * field.jfaMax : value);
  }
  return out;
}

std::span<const float> floats(const std::vector<glm::vec3>& values) {
  return {reinterpret_cast<const float*>(values.data()), values.size() * 3};
}

/// One row of the matrix in host memory: columns ascending, each once.
struct HostRow {
  std::vector<int32_t> columns;
  std::vector<float> weights;
};

HostRow readRow(const FormFactors& matrix, const MatrixArrays& arrays, const std::vector<uint32_t>& segment,
                uint32_t start, glm::uvec2 info) {
  HostRow row;
  const uint32_t count = rowEntries(info);
  if (matrix.format == MatrixFormat::csr) {
    const float weight = std::bit_cast<float>(info.y);
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t entry = segment.at(size_t{start} + i);
      row.columns.push_back(static_cast<int32_t>(entry & ((1u << arrays.columnBits) - 1u)));
      row.weights.push_back(static_cast<float>(entry >> arrays.columnBits) * weight);
    }
    return row;
  }
  std::vector<std::pair<uint32_t, float>> places;
  for (uint32_t i = 0; i < count; ++i) {
    const size_t place = 2 * (size_t{start} + i);
    places.emplace_back(segment.at(place), std::bit_cast<float>(segment.at(place + 1)));
  }
  std::sort(places.begin(), places.end());
  for (const auto& [column, weight] : places) {
    if (!row.columns.empty() && row.columns.back() == static_cast<int32_t>(column)) {
      row.weights.back() += weight;
    } else {
      row.columns.push_back(static_cast<int32_t>(column));
      row.weights.push_back(weight);
    }
  }
  return row;
}

/// Calls f(row) for every row, in order; one segment in memory at a time.
template <class F>
void forEachRow(Context& context, const FormFactors& matrix, F&& f) {
  const MatrixArrays arrays = downloadAs<MatrixArrays>(context, matrix.record).at(0);
  const std::vector<glm::uvec2> info = downloadAs<glm::uvec2>(context, matrix.rowInfo);
  std::vector<uint32_t> starts;
  if (matrix.format == MatrixFormat::csr) starts = downloadAs<uint32_t>(context, matrix.rowStart);
  std::vector<uint32_t> segment;
  uint32_t held = UINT32_MAX;
  for (uint32_t r = 0; r < matrix.rows; ++r) {
    const uint32_t wanted = r >> arrays.segmentShift;
    if (wanted != held) segment = downloadAs<uint32_t>(context, matrix.segments.at(held = wanted));
    const uint32_t within = r & ((1u << arrays.segmentShift) - 1u);
    f(readRow(matrix, arrays, segment, starts.empty() ? within * arrays.stride : starts[r], info[r]));
  }
}

}  // namespace

fs::path exportVolume(Context& context, Volume volume, const FacetList& facets, const Field& field,
                      const Lighting& lighting, const fs::path& folder) {
  const fs::path path = folder / (std::string(EnumNames<Volume>::names.at(static_cast<size_t>(volume))) + ".npy");
  const glm::uvec3 dims = facets.grid.dims;
  if (volume == Volume::distance) {
    writeNpy<float>(path, {dims.z, dims.y, dims.x}, distances(context, facets, field));
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
  forEachRow(context, matrix,
             [&](const HostRow& row) { indptr.push_back(indptr.back() + static_cast<int64_t>(row.columns.size())); });
  const auto entries = static_cast<uint64_t>(indptr.back());
  NpyFile<int32_t> indices(folder / "indices.npy", {entries});
  NpyFile<float> data(folder / "data.npy", {entries});
  forEachRow(context, matrix, [&](const HostRow& row) {
    indices.write(row.columns);
    data.write(row.weights);
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
