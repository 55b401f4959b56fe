#include "gi/study/thesis_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "gi/study/plot.h"
#include "gi/thesis/literal_grid.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"

namespace irad {
namespace {

/// What the thesis's stages are called here, and in which kind of work they run (docs/method.md 11).
struct StageHere {
  const char *thesis, *here, *kind;
};
constexpr StageHere kStages[] = {
    {"GI Iteration EmissionGather", "GI Gather", "relight"},
    {"GI Iteration Jacobi", "GI Solve", "relight"},
    {"GI Iteration Scatter", "GI Scatter", "relight"},
    {"GI clearEmission", "GI Scatter Clear", "relight"},
    {"RE Depth", "RE Depth", "camera"},
    {"RE Forward", "RE Forward", "camera"},
    {"RE Shadow", "RE Shadow", "relight"},
    {"GI BuildMatrix Clear", "GI BuildMatrix Clear", "setup"},
    {"GI BuildMatrix CompactList", "GI CompactList", "setup"},
    {"GI BuildMatrix matrixconstruction", "GI BuildMatrix", "setup"},
    {"GI JFA", "GI SDF", "setup"},
    {"GI Voxelization", "GI Voxelization", "setup"},
};

/// T Tables 2 and 3.
struct PublishedScene {
  const char *scene, *name;
  glm::dvec3 extent;
  std::array<const char*, 3> grids;  ///< of 128, 256 and 512 voxels
  std::array<double, 3> edges;
  uint32_t vertices, triangles, solid;
};
constexpr std::array<uint32_t, 3> kResolutions{128, 256, 512};
const PublishedScene kPublished[] = {
    {"park",
     "AbstractPark",
     {45.52, 27.44, 45.52},
     {"128x77x128", "256x154x256", "512x308x512"},
     {0.3556, 0.1778, 0.0889},
     4080,
     3820,
     693691},
    {"arena",
     "Arena",
     {304.56, 79.18, 543.48},
     {"71x18x128", "143x37x256", "286x74x512"},
     {4.2459, 2.1230, 1.0615},
     7004,
     5187,
     45290},
    {"box",
     "Box",
     {10.65, 10.65, 10.65},
     {"128x128x128", "256x256x256", "512x512x512"},
     {0.0832, 0.0416, 0.0208},
     5265,
     5022,
     450793},
    {"sponza",
     "Sponza",
     {3720.85, 1555.88, 2288.23},
     {"128x53x78", "256x107x157", "512x214x314"},
     {29.069, 14.535, 7.267},
     184406,
     262267,
     441511},
};

const ExperimentResult* experimentOfScene(const NamedResults& results, const char* scene) {
  for (const ExperimentResult& e : results.experiments)
    if (e.experiment.name == scene) return &e;
  return nullptr;
}
/// A figure of an experiment as text; empty where it has none.
std::string figure(const ExperimentResult* e, const char* name) {
  if (!e || !e->figures.contains(name)) return "";
  return fmt::format("{}", e->figures.at(name));
}

}  // namespace

std::string csvOf(const TextTable& table) {
  std::string out;
  for (const std::vector<std::string>& row : table) {
    for (size_t i = 0; i < row.size(); ++i) out += (i > 0 ? "," : "") + csvField(row[i]);
    out += "\n";
  }
  return out;
}

std::string htmlOf(const TextTable& table) {
  std::string out = "<table>\n";
  for (size_t row = 0; row < table.size(); ++row) {
    out += "<tr>";
    for (size_t i = 0; i < table[row].size(); ++i) {
      const char* tag = row == 0 ? "th" : "td";
      out += fmt::format("<{0}{1}>{2}</{0}>", tag, i == 0 ? " class=\"name\"" : "", escapeXml(table[row][i]));
    }
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

const std::vector<ThesisTime>& thesisTimes() {
  // clang-format off
  static const std::vector<ThesisTime> times{
    {6, "GI Iteration EmissionGather", {0.0771, 0.0303, 0.1746, 0.0071, 0.0774, 0.0826, 0.0856, 1390}},
    {6, "GI Iteration Jacobi", {0.2183, 0.0198, 0.2338, 0.0240, 0.2212, 0.2259, 0.2278, 1388}},
    {6, "GI Iteration Scatter", {0.0080, 0.0066, 0.0292, 0.0013, 0.0079, 0.0082, 0.0117, 1388}},
    {6, "GI clearEmission", {0.0622, 0.0189, 0.1624, 0.0069, 0.0624, 0.0677, 0.0703, 1390}},
    {6, "RE Depth", {0.0280, 0.0134, 0.0309, 0.0019, 0.0283, 0.0288, 0.0290, 1387}},
    {6, "RE Forward", {0.3820, 0.1859, 0.3917, 0.0244, 0.3853, 0.3878, 0.3893, 1386}},
    {6, "RE Shadow", {0.0549, 0.0304, 0.0635, 0.0028, 0.0552, 0.0558, 0.0560, 1390}},
    {6, "GI BuildMatrix Clear", {7.8514, 7.7918, 7.8985, 0.0232, 7.8510, 7.8812, 7.8812, 20}},
    {6, "GI BuildMatrix CompactList", {0.0772, 0.0756, 0.0802, 0.0013, 0.0766, 0.0798, 0.0798, 20}},
    {6, "GI BuildMatrix matrixconstruction", {52.9653, 50.9121, 69.5263, 3.8690, 51.9483, 54.1098, 54.1098, 20}},
    {6, "GI JFA", {0.3396, 0.0607, 1.0845, 0.2978, 0.0795, 0.5727, 0.5727, 20}},
    {6, "GI Voxelization", {0.0246, 0.0109, 0.0309, 0.0044, 0.0255, 0.0287, 0.0287, 20}},
    {7, "GI Iteration EmissionGather", {0.8501, 0.1433, 1.3529, 0.1882, 0.8742, 1.1174, 1.2317, 860}},
    {7, "GI Iteration Jacobi", {2.1341, 0.2296, 2.5527, 0.2226, 2.1308, 2.4744, 2.5193, 848}},
    {7, "GI Iteration Scatter", {0.0880, 0.0855, 0.0908, 0.0006, 0.0879, 0.0892, 0.0898, 843}},
    {7, "GI clearEmission", {0.7616, 0.0484, 1.2659, 0.1908, 0.7867, 1.0309, 1.1452, 861}},
    {7, "RE Depth", {0.1733, 0.1633, 0.1806, 0.0027, 0.1732, 0.1776, 0.1790, 862}},
    {7, "RE Forward", {0.3757, 0.3671, 0.3904, 0.0042, 0.3752, 0.3833, 0.3859, 861}},
    {7, "RE Shadow", {0.2036, 0.1966, 0.2356, 0.0034, 0.2033, 0.2091, 0.2122, 868}},
    {7, "GI BuildMatrix Clear", {7.8091, 7.7670, 7.8731, 0.0289, 7.8124, 7.8495, 7.8495, 21}},
    {7, "GI BuildMatrix CompactList", {0.2834, 0.2768, 0.2900, 0.0030, 0.2839, 0.2879, 0.2879, 21}},
    {7, "GI BuildMatrix matrixconstruction", {704.6190, 697.3982, 717.7565, 4.2556, 704.6292, 711.3079, 711.3079, 21}},
    {7, "GI JFA", {1.2863, 0.1158, 2.5813, 1.2080, 0.2922, 2.5638, 2.5638, 21}},
    {7, "GI Voxelization", {0.2335, 0.1069, 0.3891, 0.1253, 0.1609, 0.3813, 0.3813, 21}},
    {8, "GI Iteration EmissionGather", {0.8334, 0.2323, 1.5616, 0.1730, 0.7713, 1.1582, 1.2775, 1017}},
    {8, "GI Iteration Jacobi", {3.6449, 0.3638, 3.8950, 0.1907, 3.7133, 3.8068, 3.8394, 982}},
    {8, "GI Iteration Scatter", {0.1667, 0.1560, 0.1876, 0.0109, 0.1599, 0.1835, 0.1850, 979}},
    {8, "GI clearEmission", {0.7114, 0.1042, 1.4404, 0.1748, 0.6495, 1.0371, 1.1570, 1017}},
    {8, "RE Depth", {0.0298, 0.0247, 0.0538, 0.0047, 0.0286, 0.0324, 0.0511, 998}},
    {8, "RE Forward", {0.2202, 0.2062, 0.2698, 0.0113, 0.2142, 0.2369, 0.2454, 944}},
    {8, "RE Shadow", {0.0786, 0.0737, 0.1029, 0.0054, 0.0775, 0.0991, 0.1012, 1068}},
    {8, "GI BuildMatrix Clear", {7.8220, 7.7731, 7.8800, 0.0272, 7.8260, 7.8646, 7.8646, 21}},
    {8, "GI BuildMatrix CompactList", {0.4849, 0.4796, 0.4913, 0.0032, 0.4846, 0.4900, 0.4900, 21}},
   {8, "GI BuildMatrix matrixconstruction", {1108.9796, 1102.3842, 1115.1282, 3.9661, 1110.3291, 1113.8878, 1113.8878, 21}},
    {8, "GI JFA", {3.6337, 0.4096, 7.1741, 3.3190, 1.0678, 7.1250, 7.1250, 21}},
    {8, "GI Voxelization", {0.0469, 0.0324, 0.0791, 0.0104, 0.0419, 0.0616, 0.0616, 21}},
    {9, "GI Iteration EmissionGather", {0.3161, 0.2592, 0.3436, 0.0088, 0.3172, 0.3270, 0.3306, 877}},
    {9, "GI Iteration Jacobi", {3.1754, 0.2125, 3.4682, 0.2740, 3.2036, 3.2678, 3.3009, 865}},
    {9, "GI Iteration Scatter", {0.0948, 0.0918, 0.0984, 0.0007, 0.0947, 0.0959, 0.0969, 858}},
    {9, "GI clearEmission", {0.2379, 0.1689, 0.2648, 0.0112, 0.2397, 0.2488, 0.2520, 880}},
    {9, "RE Depth", {0.0126, 0.0032, 0.0141, 0.0006, 0.0127, 0.0132, 0.0133, 877}},
    {9, "RE Forward", {0.2253, 0.0601, 0.2474, 0.0083, 0.2256, 0.2323, 0.2340, 877}},
    {9, "RE Shadow", {0.0668, 0.0530, 0.0788, 0.0026, 0.0669, 0.0698, 0.0715, 884}},
    {9, "GI BuildMatrix Clear", {7.8280, 7.7548, 7.8709, 0.0293, 7.8271, 7.8676, 7.8676, 20}},
    {9, "GI BuildMatrix CompactList", {0.5969, 0.5901, 0.6054, 0.0040, 0.5965, 0.6027, 0.6027, 20}},
    {9, "GI BuildMatrix matrixconstruction", {957.9435, 949.7906, 963.7004, 3.9593, 958.1627, 963.1392, 963.1392, 20}},
    {9, "GI JFA", {6.5213, 0.6460, 12.9034, 5.8732, 0.6638, 12.5404, 12.5404, 20}},
    {9, "GI Voxelization", {0.0346, 0.0224, 0.0471, 0.0063, 0.0306, 0.0422, 0.0422, 20}},
    {10, "GI Iteration EmissionGather", {0.8747, 0.4912, 1.4879, 0.2139, 0.8955, 1.1901, 1.3369, 95}},
    {10, "GI Iteration Jacobi", {2.1019, 1.6643, 4.3489, 0.3375, 2.0680, 2.3224, 3.4627, 78}},
    {10, "GI Iteration Scatter", {0.0884, 0.0868, 0.0918, 0.0008, 0.0882, 0.0898, 0.0906, 78}},
    {10, "GI clearEmission", {0.7685, 0.3854, 1.3630, 0.2086, 0.7902, 1.0802, 1.2010, 102}},
    {10, "RE Depth", {0.1594, 0.1057, 0.4670, 0.0466, 0.2557, 0.3221, 0.3500, 1855}},
    {10, "RE Forward", {8.1193, 0.4743, 30.2343, 1.5666, 3.3898, 3.7763, 11.2402, 1768}},
    {10, "RE Shadow", {0.1798, 0.1263, 0.4172, 0.0576, 0.1732, 0.3174, 0.3989, 7231}},
  };
  // clang-format on
  return times;
}

const char* experimentOfTable(int table) {
  constexpr const char* names[] = {"arena", "sponza", "park", "box", "writeback-sponza"};
  IRAD_CHECK(table >= 6 && table <= 10, "the thesis's Tables 6 to 10");
  return names[table - 6];
}

TextTable timeTable(int table, const std::vector<TimeRow>& here) {
  TextTable out{{"stage", "thesis mean ms", "thesis min", "thesis max", "thesis std", "thesis p50", "thesis p95",
                 "thesis p99", "thesis samples", "stage here", "mean ms", "min", "max", "std", "p50", "p95", "p99",
                 "samples", "mean here / thesis mean"}};
  const auto addStats = [](std::vector<std::string>& row, const TimingStats& t) {
    for (const double value : {t.mean, t.min, t.max, t.std, t.p50, t.p95, t.p99})
      row.push_back(fmt::format("{:.4f}", value));
    row.push_back(fmt::format("{}", t.samples));
  };
  for (const ThesisTime& published : thesisTimes()) {
    if (published.table != table) continue;
    std::vector<std::string> row{published.stage};
    addStats(row, published.stats);
    for (const StageHere& stage : kStages) {
      if (published.stage != std::string_view(stage.thesis)) continue;
      std::vector<double> ms;
      for (const TimeRow& r : here)
        if (r.point == 0 && r.kind == stage.kind && r.stage == stage.here) ms.push_back(r.ms);
      row.emplace_back(stage.here);
      if (ms.empty()) continue;
      const TimingStats mine = statistics(ms);
      addStats(row, mine);
      row.push_back(fmt::format("{:.2f}", mine.mean / published.stats.mean));
    }
    row.resize(out.front().size());
    out.push_back(std::move(row));
  }
  return out;
}

TextTable extentTable(const NamedResults& results) {
  TextTable out{
      {"scene", "thesis extent", "extent", "N", "thesis grid", "grid", "thesis edge", "edge", "edge / thesis edge"}};
  for (const PublishedScene& s : kPublished) {
    const ExperimentResult* e = experimentOfScene(results, s.scene);
    const bool known = e && e->figures.contains("extent x");
    glm::dvec3 extent(0);
    if (known) extent = {e->figures.at("extent x"), e->figures.at("extent y"), e->figures.at("extent z")};
    const auto text = [](const glm::dvec3& v) { return fmt::format("{:.2f} x {:.2f} x {:.2f}", v.x, v.y, v.z); };
    for (size_t i = 0; i < kResolutions.size(); ++i) {
      std::vector<std::string> row{s.name,
                                   text(s.extent),
                                   known ? text(extent) : "",
                                   fmt::format("{}", kResolutions[i]),
                                   s.grids[i],
                                   "",
                                   fmt::format("{}", s.edges[i]),
                                   "",
                                   ""};
      if (known) {
        const glm::vec3 half = 0.5 * extent;
        const Grid grid = makeLiteralGrid(-half, half, kResolutions[i]);
        row[5] = fmt::format("{}x{}x{}", grid.dims.x, grid.dims.y, grid.dims.z);
        row[7] = fmt::format("{:.4g}", grid.edge);
        row[8] = fmt::format("{:.4g}", grid.edge / s.edges[i]);
      }
      out.push_back(std::move(row));
    }
  }
  return out;
}

TextTable geometryTable(const NamedResults& results) {
  TextTable out{{"scene", "thesis vertices", "vertices", "thesis triangles", "triangles",
                 "thesis solid voxels, N = 256", "solid voxels", "N"}};
  for (const PublishedScene& s : kPublished) {
    const ExperimentResult* e = experimentOfScene(results, s.scene);
    out.push_back({s.name, fmt::format("{}", s.vertices), figure(e, "vertices"), fmt::format("{}", s.triangles),
                   figure(e, "triangles"), fmt::format("{}", s.solid), figure(e, "solid voxels"),
                   figure(e, "resolution")});
  }
  return out;
}

std::string publishedMebibytes(const std::string& buffer) {
  constexpr std::pair<const char*, const char*> kMebibytes[] = {
      {"voxelAlbedo", "16.41"}, {"voxelRadiance", "32.83"}, {"voxelRadiancePong", "32.83"}, {"jfaScratch0", "16.41"},
      {"jfaWork0", "32.83"},    {"reverseMap", "16.41"},    {"solidList", "32.00"},         {"matrixHits", "3072.00"},
      {"rowCounts", "4.00"},    {"radianceXBuf", "16.00"},  {"emissionBuf", "16.00"}};
  for (const auto& [name, mib] : kMebibytes)
    if (buffer == name) return mib;
  return "";
}

}  // namespace irad
