// For suites of the GI stages: a scene voxelized with its field, and the matrix read back row by row.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <memory>

#include "gi/check_scenes.h"
#include "gi/stages.h"
#include "shaders/shared/normals.h"
#include "tests/support.h"

namespace irad::test {

/// One row of a matrix on the host. `hits` are 1 per place in the padded format.
struct HostRow {
  std::vector<uint32_t> columns, hits;
  uint32_t invalid = 0;
  float weight = 0;  ///< of one hit
  double sum() const {
    uint64_t n = 0;
    for (uint32_t h : hits) n += h;
    return static_cast<double>(n) * weight;
  }
};

inline std::vector<HostRow> hostRows(Context& context, const FormFactors& m) {
  const auto info = downloadAs<glm::uvec2>(context, m.rowInfo);
  const auto record = downloadAs<MatrixArrays>(context, m.record).at(0);
  std::vector<uint32_t> starts = downloadAs<uint32_t>(context, m.rowStart);
  std::vector<std::vector<uint32_t>> segments;
  for (const Buffer& s : m.segments) segments.push_back(downloadAs<uint32_t>(context, s));
  std::vector<HostRow> rows(m.rows);
  for (uint32_t r = 0; r < m.rows; ++r) {
    HostRow& row = rows[r];
    row.invalid = rowInvalid(info[r]);
    row.weight = std::bit_cast<float>(info[r].y);
    const std::vector<uint32_t>& segment = segments.at(r >> record.segmentShift);
    for (uint32_t i = 0; i < rowEntries(info[r]); ++i) {
      if (m.format == MatrixFormat::csr) {
        const uint32_t e = segment.at(starts.at(r) + i);
        row.columns.push_back(e & ((1u << record.columnBits) - 1));
        row.hits.push_back(e >> record.columnBits);
      } else {
        const uint64_t place = uint64_t{r & ((1u << record.segmentShift) - 1)} * record.stride + i;
        row.columns.push_back(segment.at(2 * place));
        row.hits.push_back(1);
        EXPECT_EQ(segment.at(2 * place + 1), info[r].y);
      }
    }
  }
  return rows;
}

/// A scene up to its field.
struct World {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<SceneOnDevice> device;
  Settings settings;
  FacetList facets;
  Field field;
};

class GiTest : public GpuTest {
 protected:
  static Settings defaults() { return defaultSettings(/*cpuDevice=*/true); }
  World world(Scene scene, const Settings& settings = defaults()) {
    World w;
    w.settings = settings;
    w.scene = std::make_unique<Scene>(std::move(scene));
    w.device = std::make_unique<SceneOnDevice>(context(), *w.scene);
    Voxels voxels = voxelize(context(), *w.device, settings);
    w.facets = compactFacets(context(), voxels, settings);
    w.field = buildField(context(), w.facets, settings);
    return w;
  }
  static Settings at(uint32_t resolution, uint32_t rays) {
    Settings s = defaults();
    s.voxel.resolution = resolution;
    s.matrix.gpu.rays = rays;
    return s;
  }
};

}  // namespace irad::test
