#include "gi/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>

#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/field.h"
#include "gi/gather_emitters.h"
#include "gi/host_matrix.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/oracle/voxels.h"
#include "gi/ray_kernel.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "renderer/base/angle.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/trace.h"
#include "shaders/shared/voxelize.h"

namespace irad {

Inspector::Inspector(Context& context, const Pipeline& pipeline) : context_(context), pipeline_(pipeline) {
  refresh();
}

void Inspector::refresh() {
  const FacetList& list = pipeline_.facets();
  const Lighting& light = pipeline_.lighting();
  if (build_ != pipeline_.revision().build) {
    places_ = FacetPlaces(context_, pipeline_);
    // A pipeline in which no ray reads a field has none.
    madeField_.reset();
    if (!pipeline_.field()) madeField_ = buildField(context_, list, pipeline_.settings());
    const Field& field = this->field();
    field_ = {field.method == FieldMethod::jfa, hostDistances(context_, list.grid, field)};
    seeds_.clear();
    if (field.jumpFlood.seeds) {
      const std::vector<std::byte> bytes = download(context_, field.jumpFlood.seeds);
      seeds_.resize(bytes.size() / sizeof(uint32_t));
      std::memcpy(seeds_.data(), bytes.data(), bytes.size());
    }
    const Buffer& rows = pipeline_.matrix().rowInfo;
    rows_ = rows ? downloadAs<glm::uvec2>(context_, rows) : std::vector<glm::uvec2>(list.count);
    build_ = pipeline_.revision().build;
    materials_ = pipeline_.revision().materials;
  } else if (materials_ != pipeline_.revision().materials) {
    places_.facets = hostFacets(context_, list);
    materials_ = pipeline_.revision().materials;
  }
  direct_ = perFacet(context_, list, light.direct);
  irradiance_ = perFacet(context_, list, light.indirect);
  radiosity_ = perFacet(context_, list, light.radiosity);
  correction_ = perFacet(context_, list, light.correction);
  sky_ = perFacet(context_, list, light.sky);
  reflected_ = perFacet(context_, list, light.writeback.used);
  standardError_ = perFacet(context_, list, light.frameMean.standardError);
}

void Inspector::requireFacets(const glm::uvec3& voxel) const {
  const bool outside = !places_.contains(glm::ivec3(voxel));
  if (!outside && !places_.facetsOf(voxel).empty()) return;
  const auto away = [&](const glm::uvec3& v) {
    const glm::dvec3 d = glm::dvec3(v) - glm::dvec3(voxel);
    return glm::dot(d, d);
  };
  const auto nearest = std::min_element(places_.facets.voxel.begin(), places_.facets.voxel.end(),
                                        [&](const glm::uvec3& a, const glm::uvec3& b) { return away(a) < away(b); });
  const glm::uvec3 dims = places_.facets.grid.dims;
  throw UsageError(
      fmt::format("voxel {},{},{} {} of {} x {} x {} voxels; {}", voxel.x, voxel.y, voxel.z,
                  outside ? "is outside of the grid" : "holds no facet in the grid", dims.x, dims.y, dims.z,
                  nearest == places_.facets.voxel.end()
                      ? std::string("no voxel holds one")
                      : fmt::format("the nearest solid voxel is {},{},{}", nearest->x, nearest->y, nearest->z)));
}

InspectedVoxel Inspector::voxel(const glm::uvec3& voxel) const {
  IRAD_CHECK(places_.contains(glm::ivec3(voxel)), "voxel {}, {}, {} is outside of the grid", voxel.x, voxel.y, voxel.z);
  const Grid& grid = places_.facets.grid;
  const uint32_t index = voxelIndex(voxel, grid.dims);
  InspectedVoxel record;
  record.voxel = voxel;
  record.world = pipeline_.scene().origin + glm::dvec3(grid.origin) + double{grid.edge} * (glm::dvec3(voxel) + 0.5);
  record.distance = field_.voxels.at(index);
  if (!seeds_.empty() && seeds_.at(index) != NO_SEED) record.seed = unpackVoxel(seeds_[index]);
  for (const uint32_t f : places_.facetsOf(voxel)) record.facets.push_back(facet(f));
  return record;
}

InspectedFacet Inspector::facet(uint32_t i) const {
  IRAD_CHECK_OP(i, <, places_.facets.count());
  InspectedFacet r;
  r.facet = i;
  r.voxel = places_.facets.voxel[i];
  r.shape = places_.list.shape[i];
  r.position = pipeline_.scene().origin + places_.facets.position[i];
  r.normal = places_.facets.normal[i];
  r.mesh = meshNormal(i);
  r.area = places_.facets.area[i];
  r.albedo = places_.facets.albedo[i];
  r.emission = places_.facets.emission[i];
  r.direct = direct_[i];
  r.irradiance = irradiance_[i];
  r.radiosity = radiosity_[i];
  const double gain = pipeline_.lighting().gain.radiosity;
  r.correction = gain * glm::dvec3(correction_[i]);
  r.sky = sky_[i];
  r.reflected = reflected_[i];
  r.standardError = standardError_[i];
  r.met = traceOnDevice(i);
  addLinks(i, r);

  r.rays.rays = static_cast<uint32_t>(r.met.size());
  for (const uint32_t met : r.met)
    ++(met == TRACE_ESCAPED   ? r.rays.escaped
       : met == TRACE_BLOCKED ? r.rays.blocked
       : met == TRACE_INVALID ? r.rays.invalid
                              : r.rays.hits);

  if (!pipeline_.matrix() && pipeline_.lighting()) return r;  // no sweeps: by brute force
  // One more sweep of the kind that made B: H <- F B, B <- (1 - omega) B + omega lambda (M + W + rho (D + H)).
  const glm::dvec3 h = r.row.contribution + r.correction + r.sky;
  const glm::dvec3 undamped = gain * (r.emission + r.reflected + r.albedo * (r.direct + h));
  const glm::dvec3 change = double{pipeline_.settings().solver.gpu.omega} * glm::abs(undamped - r.radiosity);
  r.residual = std::max({change.x, change.y, change.z});
  return r;
}

/// `hits`: of the receiver's rays on the sender; `hitsBack`: the other way round.
Link Inspector::link(uint32_t receiver, uint32_t sender, uint32_t hits, uint32_t hitsBack, bool row) const {
  const auto weight = [&](uint32_t r) { return double{std::bit_cast<float>(rows_[r].y)}; };
  Link l;
  l.facet = row ? sender : receiver;
  l.voxel = places_.facets.voxel[l.facet];
  l.position = pipeline_.scene().origin + places_.facets.position[l.facet];
  l.hits = hits;
  l.formFactor = hits * weight(receiver);
  l.distance = glm::distance(places_.facets.position[receiver], places_.facets.position[sender]);
  l.radiosity = radiosity_[sender];
  l.contribution = l.formFactor * l.radiosity;
  l.exchange = places_.facets.area[receiver] * l.formFactor;
  l.opposite = places_.facets.area[sender] * hitsBack * weight(sender);
  return l;
}

const Field& Inspector::field() const {
  return madeField_ ? *madeField_ : pipeline_.field();
}

void Inspector::addLinks(uint32_t i, InspectedFacet& record) const {
  if (!pipeline_.matrix()) return;  // there is no light to link
  const HostRow row = merged(readRow(context_, pipeline_.matrix(), i));
  const std::vector<uint32_t> column = readColumn(context_, pipeline_.matrix(), i);
  std::vector<uint32_t> inRow(column.size(), 0);
  for (size_t e = 0; e < row.columns.size(); ++e) {
    const uint32_t j = row.columns[e];
    inRow[j] = row.hits[e];
    record.row.links.push_back(link(i, j, row.hits[e], column[j], /*row=*/true));
  }
  for (uint32_t j = 0; j < column.size(); ++j)
    if (column[j] > 0) record.column.links.push_back(link(j, i, column[j], inRow[j], /*row=*/false));
  for (Links* all : {&record.row, &record.column}) {
    std::stable_sort(all->links.begin(), all->links.end(), [](const Link& a, const Link& b) {
      return luminance(glm::vec3(a.contribution)) > luminance(glm::vec3(b.contribution));
    });
    for (const Link& l : all->links) {
      all->sum += l.formFactor;
      all->contribution += l.contribution;
      all->exchange += l.exchange;
    }
  }
  // The row's sum the other way round is that of the column's links, and vice versa.
  record.row.opposite = record.column.exchange;
  record.column.opposite = record.row.exchange;
}

std::optional<MeshNormal> Inspector::meshNormal(uint32_t i) const {
  if (places_.triangles.empty()) return std::nullopt;
  const Scene& scene = pipeline_.scene();
  MeshNormal mesh;
  mesh.triangle = places_.triangles.at(i) & ~SURFEL_BACK;
  mesh.back = (places_.triangles[i] & SURFEL_BACK) != 0;
  const uint32_t* corner = &scene.indices.at(3 * size_t{mesh.triangle});
  const oracle::Triangle t = oracle::toVoxels(places_.facets.grid, scene.positions.at(corner[0]),
                                              scene.positions.at(corner[1]), scene.positions.at(corner[2]));
  const glm::dvec3 across = glm::cross(t[1] - t[0], t[2] - t[0]);
  mesh.face = glm::normalize(across) * (mesh.back ? -1.0 : 1.0);

  // Where gi/facet_shade.glsl samples it, in barycentric coordinates.
  const bool raster = pipeline_.obeyed().voxel.method == VoxelMethod::raster;
  const glm::dvec3 middle =
      (raster ? oracle::onMiddleLine : oracle::middleInside)(t, glm::ivec3(places_.facets.voxel[i]));
  glm::dvec3 normal(0);
  for (int c = 0; c < 3; ++c) {
    const glm::dvec3 area = glm::cross(t[(c + 1) % 3] - middle, t[(c + 2) % 3] - middle);
    normal += glm::dot(area, across) / glm::dot(across, across) * glm::dvec3(scene.normals.at(corner[c]));
  }
  mesh.shading = glm::length(normal) > 1e-6 ? glm::normalize(normal) : mesh.face;
  if (glm::dot(mesh.shading, mesh.face) < 0) mesh.shading = -mesh.shading;
  mesh.faceError = degreesBetween(mesh.face, places_.facets.normal[i]);
  mesh.shadingError = degreesBetween(mesh.shading, places_.facets.normal[i]);
  return mesh;
}

RowComparison compareRows(const Links& a, const Links& b) {
  std::map<uint32_t, RowComparison::Entry> all;
  for (const Link& l : a.links) all.insert({l.facet, {l.facet, l.voxel, 0, 0}}).first->second.a = l.formFactor;
  for (const Link& l : b.links) all.insert({l.facet, {l.facet, l.voxel, 0, 0}}).first->second.b = l.formFactor;
  RowComparison out;
  for (const auto& [facet, entry] : all) {
    out.entries.push_back(entry);
    out.difference += std::abs(entry.a - entry.b);
    out.shared += std::min(entry.a, entry.b);
  }
  std::stable_sort(out.entries.begin(), out.entries.end(),
                   [](const auto& x, const auto& y) { return std::abs(x.a - x.b) > std::abs(y.a - y.b); });
  return out;
}

SolveHistory replaySolve(Context& context, const Pipeline& pipeline, const std::vector<uint32_t>& facets,
                         const Progress& progress) {
  const FacetList& list = pipeline.facets();
  const Settings& settings = pipeline.obeyed();
  SolveHistory history;
  history.converged = !pipeline.matrix() || !pipeline.lighting();  // nothing to sweep with
  if (history.converged) return history;
  Lighting light = makeLighting(context, list, settings);
  Frame copy = context.beginUntimed();
  copy.pass("Copy").copy(pipeline.lighting().direct, light.direct, light.direct.bytes);
  if (const Buffer& sky = pipeline.lighting().sky) {
    light.sky = Buffer(context.device, sky.name, Subsystem::Solver, sky.bytes);
    copy.pass("Copy").copy(sky, light.sky, sky.bytes);
  }
  if (const Buffer& reflected = pipeline.lighting().writeback.used) {
    light.writeback.used = Buffer(context.device, reflected.name, Subsystem::Solver, reflected.bytes);
    copy.pass("Copy").copy(reflected, light.writeback.used, reflected.bytes);
  }
  copy.submit();
  const Emitters emitters = listEmitters(context, list);
  gatherEmitters(context, list, pipeline.matrix(), {&emitters, &pipeline.field()}, settings, light);
  while (!history.converged && history.irradiance.size() < settings.solver.maxSweeps) {
    if (progress && !progress("GI Solve", 0)) throw WorkError("cancelled");
    const SolveReport report = solve(context, list, pipeline.matrix(), light, settings, /*maxSweeps=*/1);
    std::vector<glm::vec4> h(facets.size());
    Frame frame = context.beginUntimed();
    for (size_t i = 0; i < facets.size(); ++i)
      frame.readback(light.indirect, sizeof(glm::vec4) * facets[i], sizeof(glm::vec4),
                     [to = &h[i]](std::span<const uint8_t> bytes) { std::memcpy(to, bytes.data(), bytes.size()); });
    frame.submitAndWait();
    history.irradiance.emplace_back(h.begin(), h.end());
    history.residual.push_back(report.residual);
    history.converged = report.converged;
    if (report.settled()) break;
  }
  return history;
}

}  // namespace irad
