// The table of memory: T 5.14's printed numbers where they agree with its formulas, what is said of those that do not,
// who is put beside whom, and the command on the Box beside memory.csv.
#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/lighting.h"
#include "gi/memory_report.h"
#include "gi/thesis/memory.h"
#include "renderer/base/csv.h"
#include "tests/support.h"

namespace irad::memory_suite {
namespace {

using test::contains;
using test::runIrad;
using test::RunResult;
using test::slurp;

double mib(uint64_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

/// T Table 1's Sponza: 256 x 107 x 157 voxels, M_s = 2^20.
ThesisTable printedTable(const std::vector<MemoryReportRow>& report = {}, const FacetList& names = {}) {
  FacetList facets;
  facets.reverse.name = names.reverse.name;
  facets.voxel.name = names.voxel.name;
  facets.grid.voxels = 4'300'544;
  facets.solidVoxels = 1 << 20;
  return thesisTable(report, facets, {}, {}, 384);
}

const ThesisTable::Row& find(const ThesisTable::Group& group, const std::string& buffer) {
  const auto row = std::find_if(group.rows.begin(), group.rows.end(), [&](auto& r) { return r.buffer == buffer; });
  if (row == group.rows.end()) ADD_FAILURE() << "no row " << buffer;
  return row == group.rows.end() ? group.sum : *row;
}

TEST(ThesisTable, HasThePrintedSizesWhereTheyFollowFromTheFormulas) {
  const ThesisTable table = printedTable();
  for (const char* buffer : {"voxelAlbedo", "jfaScratch0", "reverseMap"})
    EXPECT_NEAR(mib(*find(table.volumes, buffer).thesis), 16.41, 0.005) << buffer;
  // Printed 32.83: not 8 V.
  for (const char* buffer : {"voxelRadiance", "voxelRadiancePong", "jfaWork0"}) {
    EXPECT_EQ(find(table.volumes, buffer).thesis, 34'404'352u) << buffer;
    EXPECT_NEAR(mib(*find(table.volumes, buffer).thesis), 32.81, 0.005) << buffer;
  }
  const std::map<std::string, double> printed{
      {"solidList", 32}, {"matrixHits", 3072}, {"rowCounts", 4}, {"radianceXBuf", 16}, {"emissionBuf", 16}};
  double listed = 0;
  for (const auto& [buffer, size] : printed) {
    EXPECT_NEAR(mib(*find(table.matrix, buffer).thesis), size, 0.005) << buffer;
    listed += size;
  }
  EXPECT_EQ(listed, 3140);                                  // as printed
  EXPECT_NEAR(mib(*table.matrix.sum.thesis), 3156, 0.005);  // with the third vec4 array of eq. 30
}

TEST(ThesisTable, AddsUpToTheEquations) {
  const ThesisTable table = printedTable();
  EXPECT_EQ(table.volumes.sum.thesis, 154'819'584u);             // 36 V
  EXPECT_EQ(table.matrix.sum.thesis, 3'309'305'872u);            // 2^20 (84 + 8 x 384) + 16
  EXPECT_EQ(table.total.thesis, 154'819'584u + 3'309'305'872u);  // 3303.65 MiB
  const ThesisMemory memory = thesisMemory(4'300'544, 1 << 20, 384);
  EXPECT_EQ(table.volumes.sum.thesis, memory.volumes);
  EXPECT_EQ(table.matrix.sum.thesis, memory.matrix);
  EXPECT_EQ(table.total.thesis, memory.total);
}

TEST(ThesisTable, EveryResourceIsInOneRow) {
  FacetList names;
  names.reverse.name = "reverse";
  names.voxel.name = "voxel";
  const ThesisTable table = printedTable({{"reverse", "facets", "", 40, 39},
                                          {"voxel", "facets", "", 16, 12},
                                          {"pieces", "facets", "", 160, std::nullopt},
                                          {"Grid", "voxels", "", 48, 48},
                                          {kMatrixEntries, "matrix", "", 1000, 900},
                                          {"row info", "matrix", "", 80, 80},
                                          {"row starts", "matrix", "", 40, 40},
                                          {"H", "solver", "", 7, 7},
                                          {"a texture", "scene", "", 5, 5},
                                          {"another", "scene", "", 6, 6},
                                          {"subtotal", "facets", "", 9, {}, MemoryReportRow::Kind::Subtotal}},
                                         names);
  EXPECT_EQ(find(table.volumes, "reverseMap").measured, 40u);
  EXPECT_EQ(find(table.volumes, "voxelAlbedo").measured, std::nullopt);
  EXPECT_EQ(table.volumes.sum.measured, 88u);
  EXPECT_EQ(table.volumes.sum.predicted, 87u);
  EXPECT_EQ(find(table.matrix, "solidList").here, (std::vector<std::string>{"voxel"}));
  EXPECT_EQ(find(table.matrix, "matrixHits").predicted, 900u);
  EXPECT_EQ(find(table.matrix, "rowCounts").measured, 120u);
  EXPECT_EQ(find(table.matrix, "rowCounts").here, (std::vector<std::string>{"row info", "row starts"}));
  // A sum that one part has no prediction for has none.
  EXPECT_EQ(find(table.matrix, "(surface that rays meet)").predicted, std::nullopt);
  EXPECT_EQ(table.matrix.sum.predicted, std::nullopt);
  EXPECT_EQ(table.matrix.sum.measured, 16u + 160 + 1000 + 120 + 7);
  EXPECT_EQ(table.total.measured, 88u + 16 + 160 + 1000 + 120 + 7);
  ASSERT_EQ(table.others.rows.size(), 1u);
  EXPECT_EQ(table.others.rows[0].buffer, "scene");
  EXPECT_EQ(table.others.sum.measured, 11u);
  EXPECT_EQ(table.all.measured, *table.total.measured + 11);
  EXPECT_EQ(table.all.thesis, std::nullopt);
}

TEST(ThesisTable, MisprintsAreStatedWithTheirFigures) {
  const std::vector<std::string> misprints = thesisMisprints();
  const std::string text = std::accumulate(misprints.begin(), misprints.end(), std::string());
  for (const char* part : {"seven textures", "counts six", "32.83 MiB", "8 V is 32.81", "147.72 MiB", "eq. 29 147.65",
                           "3140.00 MiB", "instead of 3156.00", "3287.72 MiB", "3303.65, 15.93 more",
                           "2^19 for 441511 solid voxels", "1725.65 MiB", "eq. 30 (97.3 %)", "93.0 %", "95.5 %"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
}

/// Rows by "subsystem,buffer", each by its columns' names.
using Table = std::map<std::string, std::map<std::string, std::string>>;
Table readTable(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> columns = csvFields(line);
  Table table;
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = csvFields(line);
    auto& row = table[fields.at(0) + "," + fields.at(1)];
    for (size_t i = 0; i < columns.size(); ++i) row[columns[i]] = fields.at(i);
  }
  return table;
}

uint64_t number(const std::string& text) {
  return text.empty() ? 0 : std::stoull(text);
}

std::vector<std::string> boxOptions(const std::string& preset) {
  return {"box",
          "--preset",
          preset,
          "--set",
          "voxel.resolution=16",
          "--set",
          "matrix.rays=32",
          "--set",
          "light.shadow_resolution=64"};
}

/// `irad memory` of a small Box, and `irad render`'s memory.csv.
void boxTable(const std::string& preset) {
  test::TemporaryFolder folder;
  const std::string csv = (folder.path / "table.csv").string();
  std::vector<std::string> memory = boxOptions(preset), render = memory;
  memory.insert(memory.begin(), "memory");
  memory.insert(memory.end(), {"--csv", csv, "--validate"});
  render.insert(render.begin(), "render");
  render.insert(render.end(), {"--out", folder.path.string(), "--size", "32x32"});
  const RunResult run = test::startIrad(memory), rendered = runIrad(render);
  ASSERT_EQ(run.status, 0) << run.err;
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  for (const char* part : {"M_s = ", "R = 32", "thesis_mib", "predicted_mib", "measured_mib", "3303.65", "seven"})
    EXPECT_TRUE(contains(run.out, part)) << part << "\n" << run.out;

  Table table = readTable(slurp(csv));
  std::map<std::string, uint64_t> resources, sums;  // of memory.csv
  std::istringstream lines(slurp(folder.path / "memory.csv"));
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> fields = csvFields(line);
    if (fields.at(0) == "name") continue;
    (contains(fields.at(0), "formula of the thesis") ? sums : resources)[fields[0]] += number(fields[3]);
    if (contains(fields[0], "all of gi")) {
      EXPECT_EQ(table["GI,total"]["thesis_bytes"], fields[4]);
    }
  }
  // The three sums, and every row by the resources that it names.
  EXPECT_EQ(number(table["Voxel volumes,subtotal"]["measured_bytes"]), sums["volumes (formula of the thesis)"]);
  EXPECT_EQ(number(table["Matrix GI,subtotal"]["measured_bytes"]), sums["matrix and list (formula of the thesis)"]);
  EXPECT_EQ(number(table["GI,total"]["measured_bytes"]), sums["all of gi (formula of the thesis)"]);
  std::map<std::string, uint64_t> added;
  for (auto& [name, row] : table) {
    const std::string group = row["subsystem"];
    if ((group != "Voxel volumes" && group != "Matrix GI") || row["buffer"] == "subtotal") continue;
    uint64_t measured = 0;
    std::string here = row["here"];
    for (size_t end = 0; !here.empty(); here.erase(0, end)) {
      end = std::min(here.find("; "), here.size());
      const std::string resource = here.substr(0, end);
      EXPECT_TRUE(resources.contains(resource)) << resource;
      measured += resources[resource];
      end = std::min(end + 2, here.size());
    }
    EXPECT_EQ(number(row["measured_bytes"]), measured) << name;
    // All of it is predicted, but for what images and small buffers are rounded up to.
    EXPECT_EQ(row["measured_bytes"].empty(), row["predicted_bytes"].empty()) << name;
    EXPECT_GE(number(row["measured_bytes"]) + 16, number(row["predicted_bytes"])) << name;
    for (const char* column : {"thesis_bytes", "predicted_bytes", "measured_bytes"})
      added[group + column] += number(row[column]);
  }
  for (const char* group : {"Voxel volumes", "Matrix GI"})
    for (const char* column : {"thesis_bytes", "predicted_bytes", "measured_bytes"})
      EXPECT_EQ(number(table[std::string(group) + ",subtotal"][column]), added[std::string(group) + column])
          << group << column;
  const bool thesis = preset == "thesis";
  EXPECT_EQ(table["Matrix GI,matrixHits"]["predicted_bytes"] == table["Matrix GI,matrixHits"]["thesis_bytes"], thesis);
  EXPECT_EQ(contains(table["Voxel volumes,jfaScratch0"]["here"], "jfa"), thesis);
  EXPECT_EQ(table.contains("Matrix GI,(surface that rays meet)"), !thesis);
}

TEST(MemoryCommand, TheBoxAsMemoryCsvHasIt) {
  boxTable("balanced");
}

TEST(MemoryCommand, TheBoxAsTheThesisHasIt) {
  boxTable("thesis");
}

TEST(MemoryCommand, MarkdownIsTheSameTable) {
  std::vector<std::string> arguments = boxOptions("balanced");
  arguments.insert(arguments.begin(), "memory");
  arguments.emplace_back("--markdown");
  const RunResult run = runIrad(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "| subsystem | buffer | formula | thesis_mib | predicted_mib | measured_mib | here |"))
      << run.out;
  EXPECT_TRUE(contains(run.out, "| Matrix GI | matrixHits | 8 R M_s | ")) << run.out;
}

/// Without light there is no matrix; the thesis has one all the same.
TEST(MemoryCommand, ASceneWithoutLightHasTheThesissMatrixBesideNone) {
  test::TemporaryFolder folder;
  const std::string csv = (folder.path / "table.csv").string();
  std::vector<std::string> arguments{"memory", "check:lights-off",    "--csv", csv,
                                     "--set",  "voxel.resolution=16", "--set", "matrix.rays=32"};
  const RunResult run = runIrad(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
  Table table = readTable(slurp(csv));
  EXPECT_EQ(number(table["Matrix GI,matrixHits"]["thesis_bytes"]),
            8 * number(table["Matrix GI,rowCounts"]["thesis_bytes"]) / 4 * 32);
  EXPECT_EQ(number(table["Matrix GI,matrixHits"]["measured_bytes"]), 0u);
  EXPECT_FALSE(table["GI,total"]["predicted_bytes"].empty());  // of all, arrays of nothing among them
}

TEST(MemoryCommand, BadInputHasTheUsualStatuses) {
  const RunResult scene = runIrad({"memory", "bxo"});
  EXPECT_EQ(scene.status, 3);
  EXPECT_TRUE(contains(scene.err, "bxo: no such file; built-in scenes (did you mean box?)")) << scene.err;
  test::TemporaryFolder folder;
  const std::string csv = (folder.path / "absent" / "table.csv").string();
  const RunResult file = runIrad({"memory", "box", "--csv", csv});
  EXPECT_EQ(file.status, 1);
  EXPECT_TRUE(contains(file.err, csv)) << file.err;
  EXPECT_EQ(file.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder.path / "absent"));
  const RunResult setting = runIrad({"memory", "box", "--set", "matrix.rayz=4"});
  EXPECT_EQ(setting.status, 2);
  EXPECT_TRUE(contains(setting.err, "did you mean matrix.rays")) << setting.err;
  const RunResult option = runIrad({"memory", "box", "--cvs", "x"});
  EXPECT_EQ(option.status, 2);
  EXPECT_TRUE(contains(option.err, "did you mean --csv")) << option.err;
}

}  // namespace
}  // namespace irad::memory_suite
