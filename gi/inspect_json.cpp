#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gi/inspected.h"
#include "renderer/base/json_reader.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

using Json = nlohmann::ordered_json;

Json array(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
Json array(const glm::uvec3& v) {
  return {v.x, v.y, v.z};
}

/// What a ray met as one number: the facet, or -1 escaped, -2 blocked, -3 invalid.
int64_t metNumber(uint32_t met) {
  return met <= TRACE_LAST_FACET ? int64_t{met} : static_cast<int32_t>(met);
}

Json linksJson(const Links& links) {
  Json entries = Json::array();
  for (const Link& l : links.links)
    entries.push_back({{"facet", l.facet},
                       {"voxel", array(l.voxel)},
                       {"hits", l.hits},
                       {"form_factor", l.formFactor},
                       {"distance", l.distance},
                       {"radiosity", array(l.radiosity)},
                       {"contribution", array(l.contribution)},
                       {"exchange", l.exchange},
                       {"opposite", l.opposite}});
  return {{"sum", links.sum},
          {"contribution", array(links.contribution)},
          {"exchange", links.exchange},
          {"opposite", links.opposite},
          {"entries", entries}};
}

Json facetJson(const InspectedFacet& f, NormalEncoding encoding) {
  Json json;
  json["facet"] = f.facet;
  json["position"] = array(f.position);
  Json normal{{"stored", f.shape & 0xFFFFu}, {"encoding", nameOf(encoding)}, {"decoded", array(f.normal)}};
  if (f.mesh) {
    normal["triangle"] = f.mesh->triangle;
    normal["back_side"] = f.mesh->back;
    normal["face"] = array(f.mesh->face);
    normal["shading"] = array(f.mesh->shading);
    normal["face_error_degrees"] = f.mesh->faceError;
    normal["shading_error_degrees"] = f.mesh->shadingError;
  }
  json["normal"] = normal;
  json["plane_offset"] = facetOffset(f.shape);
  json["shape"] = f.shape;
  json["area"] = f.area;
  json["albedo"] = array(f.albedo);
  json["emission"] = array(f.emission);
  json["direct"] = array(f.direct);
  json["irradiance"] = array(f.irradiance);
  json["radiosity"] = array(f.radiosity);
  json["emitter_correction"] = array(f.correction);
  json["sky"] = array(f.sky);
  json["reflected"] = array(f.reflected);
  json["residual"] = f.residual;
  const double n = f.rays.rays;
  json["rays"] = {{"count", f.rays.rays},
                  {"hits", f.rays.hits},
                  {"escaped", f.rays.escaped},
                  {"blocked", f.rays.blocked},
                  {"invalid", f.rays.invalid},
                  {"escaped_share", f.rays.escaped / n},
                  {"invalid_share", f.rays.invalid / n}};
  Json met = Json::array();
  for (const uint32_t m : f.met) met.push_back(metNumber(m));
  json["rays"]["met"] = met;
  json["row"] = linksJson(f.row);
  json["column"] = linksJson(f.column);
  return json;
}

/// Arrays of numbers on one line each.
std::string folded(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const size_t end = text[i] == '[' ? text.find_first_of("[]{", i + 1) : std::string::npos;
    if (end == std::string::npos || text[end] != ']') {
      out += text[i];
      continue;
    }
    for (; i <= end; ++i)
      if (text[i] == ',')
        out += ", ";
      else if (text[i] != ' ' && text[i] != '\n')
        out += text[i];
    --i;
  }
  return out;
}

}  // namespace

std::string inspectJson(const InspectedVoxel& record, const Grid& grid, NormalEncoding encoding,
                        const SolveHistory& history) {
  Json json;
  json["voxel"] = array(record.voxel);
  json["world"] = array(record.world);
  json["distance"] = {{"voxels", record.distance}, {"metres", record.distance * double{grid.edge}}};
  if (record.seed) json["jfa_seed"] = array(*record.seed);
  json["facets"] = Json::array();
  for (size_t f = 0; f < record.facets.size(); ++f) {
    Json facet = facetJson(record.facets[f], encoding);
    Json h = Json::array();
    for (const std::vector<glm::vec3>& sweep : history.irradiance) h.push_back(array(glm::dvec3(sweep.at(f))));
    facet["irradiance_history"] = h;
    json["facets"].push_back(facet);
  }
  json["residual_history"] = history.residual;
  json["converged"] = history.converged;
  return folded(jsonText(json, 1)) + "\n";
}

}  // namespace irad
