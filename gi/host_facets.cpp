#include "gi/host_facets.h"

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/oracle/rays.h"
#include "renderer/base/error.h"
#include "renderer/frame/transfer.h"
#include "renderer/resources.h"
#include "shaders/shared/normals.h"

namespace irad {
namespace {

/// surfelAt of gi/surface_point.h for all surfels.
std::vector<Surfel> hostSurfels(const oracle::Facets& facets, uint32_t count, const std::vector<uint32_t>& words,
                                const std::vector<uint32_t>& wideSides) {
  std::vector<Surfel> surfels;
  for (size_t facet = 0; facet < count; ++facet) {
    const uint32_t* at = &words.at(SURFEL_WORDS * facet);
    const uint32_t* sides = at + FACET_SURFELS;
    for (uint32_t k = 0; k < FACET_SURFELS; ++k) {
      const uint32_t side = sides[1] == WIDE_SIDES
                                ? wideSides.at(WIDE_WORDS * size_t{sides[0]} + k / 2) >> (16 * (k % 2)) & 0xFFFFu
                                : sides[k / 4] >> (8 * (k % 4)) & 0xFFu;
      const uint32_t triangle = facets.pieces.at(facets.firstPiece.at(facet) + side / 2) & ~PIECE_SMALL;
      surfels.push_back({triangle | ((side & 1u) != 0 ? SURFEL_BACK : 0u), at[k]});
    }
  }
  return surfels;
}

}  // namespace

HostFacets hostFacets(Context& context, const FacetList& list) {
  HostFacets host;
  host.grid = list.grid;
  if (list.count == 0) return host;
  const auto voxel = downloadAs<uint32_t>(context, list.voxel), shape = downloadAs<uint32_t>(context, list.shape);
  const auto albedo = downloadAs<glm::uvec2>(context, list.albedo);
  const auto area = downloadAs<float>(context, list.area);
  for (uint32_t i = 0; i < list.count; ++i) {
    host.voxel.push_back(unpackVoxel(voxel[i]));
    host.normal.emplace_back(decodeNormal(shape[i] & 0xFFFFu, list.encoding));
    host.position.push_back(glm::dvec3(list.grid.origin) +
                            double{list.grid.edge} *
                                (glm::dvec3(host.voxel[i]) + 0.5 + double{facetOffset(shape[i])} * host.normal[i]));
    host.albedo.push_back(unpackAlbedo(albedo[i]));
    host.area.push_back(double{list.grid.edge} * list.grid.edge * double{area[i]});
  }
  if (list.surface) {  // what a facet stands for may lie to one side of its voxel
    const oracle::Facets surface = oracleFacets(context, list);
    for (uint32_t i = 0; i < list.count; ++i) {
      glm::dvec3 sum(0);
      for (uint32_t k = 0; k < FACET_SURFELS; ++k)
        sum += host.surfels.emplace_back(glm::dvec3(list.grid.origin) +
                                         double{list.grid.edge} * surface.point(FACET_SURFELS * i + k));
      host.position[i] = sum / double{FACET_SURFELS};
    }
  }
  host.emission = list.hasEmission ? downloadAs<glm::vec3>(context, list.emission)
                                   : std::vector<glm::vec3>(list.count, glm::vec3(0));
  host.emission.resize(list.count);
  return host;
}

oracle::Facets oracleFacets(Context& context, const FacetList& list) {
  oracle::Facets host{.grid = list.grid,
                      .encoding = list.encoding,
                      .voxel = downloadAs<uint32_t>(context, list.voxel),
                      .shape = downloadAs<uint32_t>(context, list.shape),
                      .reverse = downloadAs<uint32_t>(context, list.reverse)};
  if (const Surface& s = list.surface) {
    host.corners = downloadAs<glm::vec4>(context, s.corners);
    host.firstPiece = downloadAs<uint32_t>(context, s.firstPiece);
    host.pieces = downloadAs<uint32_t>(context, s.pieces);
    host.sides = downloadAs<uint32_t>(context, s.sides);
    host.cuts = downloadAs<uint32_t>(context, s.cuts);
    host.surfels = hostSurfels(host, list.count, downloadAs<uint32_t>(context, s.surfels),
                               downloadAs<uint32_t>(context, s.wideSides));
    host.area = downloadAs<float>(context, list.area);
  }
  return host;
}

std::vector<glm::vec3> perFacet(Context& context, const FacetList& list, const Buffer& values) {
  std::vector<glm::vec3> out;
  if (values)
    for (const glm::vec4& v : downloadAs<glm::vec4>(context, values)) out.emplace_back(v);
  out.resize(list.count, glm::vec3(0));  // an empty list still has 16 bytes
  return out;
}

std::vector<float> hostDistances(Context& context, const Grid& grid, const Field& field) {
  const bool jfa = field.method == FieldMethod::jfa;
  const std::vector<std::byte> bytes =
      jfa ? download(context, field.jumpFlood.distance) : download(context, field.chebyshev);
  IRAD_CHECK_OP(bytes.size(), >=, grid.voxels);
  std::vector<float> out;
  out.reserve(grid.voxels);
  for (uint32_t v = 0; v < grid.voxels; ++v) {
    const float value = static_cast<float>(std::to_integer<uint32_t>(bytes[v]));
    out.push_back(jfa ? value / 255.0f * field.jumpFlood.largest : value);
  }
  return out;
}

}  // namespace irad
