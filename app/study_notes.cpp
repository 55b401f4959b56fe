// What is said of a study: the notes that its report begins with, and the table on the screen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study_ahead.h"
#include "app/study_run.h"
#include "app/table.h"
#include "renderer/base/console.h"
#include "renderer/base/number_text.h"

namespace irad::app {
namespace {

/// A third of the picture's width and height, 16 to 128 pixels, where the truth has most contrast.
void chooseCrop(const Truth& truth, ReportNotes& notes) {
  notes.pictureSize = truth.size;
  notes.cropSize = glm::min(glm::max(truth.size / 3u, glm::uvec2(16)), glm::uvec2(128));
  notes.cropSize = glm::min(notes.cropSize, truth.size);
  const LinearPixels mean = truth.mean();
  double most = -1;
  const glm::uvec2 step = glm::max(notes.cropSize / 4u, glm::uvec2(1));
  for (uint32_t y0 = 0; y0 + notes.cropSize.y <= truth.size.y; y0 += step.y)
    for (uint32_t x0 = 0; x0 + notes.cropSize.x <= truth.size.x; x0 += step.x) {
      double sum = 0, squares = 0, n = 0;
      for (uint32_t y = y0; y < y0 + notes.cropSize.y; ++y)
        for (uint32_t x = x0; x < x0 + notes.cropSize.x; ++x) {
          const glm::vec4& p = mean[size_t{y} * truth.size.x + x];
          const double value = std::log(1e-4 + std::max(0.0, double{p.x} + p.y + p.z));
          sum += value, squares += value * value, ++n;
        }
      const double variance = squares / n - (sum / n) * (sum / n);
      if (variance > most) most = variance, notes.cropAt = {x0, y0};
    }
}

}  // namespace

ReportNotes StudyRun::notes() const {
  ReportNotes notes;
  const TruthSource& truth = task_.truth;
  bool fewer = false;
  for (size_t point = 0; point < grid_.size(); ++point)
    fewer = fewer || timedRepeats(grid_.settings(point), task_.repeats) < task_.repeats;
  notes.facts = {
      fmt::format("Scene {}, camera {}, view {}, {} × {} pixels", scene_.path.filename().string(),
                  task_.camera.name.empty() ? "of its own" : task_.camera.name, task_.view.name, task_.size.x,
                  task_.size.y),
      fmt::format("Reference: {}", truth.file ? truth.file->path.filename().string() : truth_.what),
      fmt::format("Device: {}; times are GPU time stamps, medians of {} repeats with all points in turn, after a round "
                  "that warms up{}{}",
                  session_.device->info.name, task_.repeats,
                  fewer ? " (of brute force by the number of its frames fewer, three at least)" : "",
                  task_.repeats < 30 ? fmt::format("; {} repeats are few: 30 and more are meant", task_.repeats) : ""),
      fmt::format("Errors: {} seeds from {} on; relMSE of means over {} × {} pixels, ε = (0.1 × mean)²; ± is half of "
                  "a 95 % interval over seeds (Student's t)",
                  task_.seeds, grid_.base().matrix.gpu.seed, kBlockSide, kBlockSide)};
  if (task_.facetRays)
    notes.facts.push_back(
        fmt::format("H of facets: against brute force of {} rays per facet on the same facets, twice, whose noise "
                    "cancels; means over facets and channels, ε = (0.1 × mean)²",
                    withThousands(*task_.facetRays)));
  if (!task_.peerSamples.empty())
    notes.facts.push_back(
        "Path tracer: Embree on this machine's CPU, diffuse, one sample through each pixel's middle; "
        "every picture takes all of its time");
  if (!truth_.first.empty()) chooseCrop(truth_, notes);
  return notes;
}

void finishStudy(const std::filesystem::path& out, const SettingGrid& grid, const StudyResults& results,
                 const ReportNotes& notes, const std::vector<SplitPoint>& splits) {
  writeReport(out, grid, results, notes, splits);
  const std::vector<PointSummary> points = summarize(results, grid.labels());
  const bool ofFacets = std::ranges::any_of(points, [](const PointSummary& p) { return !std::isnan(p.hRelMse.mean); });
  std::vector<std::vector<std::string>> rows{
      {"point", "settings", "relMSE", "±", "FLIP", "build ms", "relight ms", "frame ms", "MiB", ""}};
  std::vector<bool> right{true, false, true, true, true, true, true, true, true, false};
  const auto insertFacets = [&](std::vector<std::string>& row, const std::string& mean, const std::string& half) {
    if (ofFacets) row.insert(row.begin() + 4, {mean, half});
  };
  if (ofFacets) right.insert(right.begin() + 4, {true, true});
  insertFacets(rows[0], "of H", "±");
  for (const PointSummary& p : points) {
    const auto ms = [&](const char* kind) {
      return std::isfinite(p.gpuMs(kind)) ? milliseconds(p.gpuMs(kind)) : std::string("-");
    };
    const bool done = p.seeds > 0;
    rows.push_back({std::to_string(p.point), p.label, done ? shortNumber(p.relMse.mean) : "-",
                    done && std::isfinite(p.relMse.half) ? shortNumber(p.relMse.half) : "-",
                    done ? shortNumber(p.flip.mean) : "-", ms("setup"), ms("relight"), ms("camera"),
                    done ? fmt::format("{:.1f}", p.deviceMib) : "-", p.failure});
    const MeanInterval& h = p.hRelMse;
    insertFacets(rows.back(), done && !std::isnan(h.mean) ? shortNumber(h.mean) : "-",
                 done && std::isfinite(h.half) ? shortNumber(h.half) : "-");
  }
  print("{}", formatTable(rows, right));
  for (const std::string& finding : findings(points, results.peers, grid.find(grid.base()))) print("{}\n", finding);
  print("wrote       {}\n", (out / "report.html").string());
}

}  // namespace irad::app
