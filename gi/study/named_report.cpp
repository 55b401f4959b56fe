#include "gi/study/named_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gi/study/html.h"
#include "gi/study/plot.h"
#include "gi/study/report_parts.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

namespace fs = std::filesystem;

const char* classOf(Judgement verdict) {
  return verdict == Judgement::Agrees      ? "agrees"
         : verdict == Judgement::Disagrees ? "disagrees"
         : verdict == Judgement::Answered  ? "answered"
                                           : "open";
}

std::string findingRows(const NamedReport& report) {
  std::string out;
  for (const Claim& claim : report.study->claims) {
    const Answer answer = answerTo(claim, report.results);
    out += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"here\">{}</td><td class=\"{}\">{}</td></tr>\n",
                       escapeXml(claim.section), escapeXml(claim.said), escapeXml(answer.text), classOf(answer.verdict),
                       toString(answer.verdict));
  }
  return out;
}
std::string findingTable(const std::string& rows) {
  return "<table class=\"said\">\n<tr><th class=\"name\">in</th><th class=\"name\">the thesis found</th><th "
         "class=\"name\">measured here</th><th class=\"name\">verdict</th></tr>\n" +
         rows + "</table>\n";
}

const char* truthOf(TruthKind truth) {
  switch (truth) {
    case TruthKind::PathTracer:
      return "Truth: the path tracer on the triangles, which is diffuse.";
    case TruthKind::OwnSettings:
      return "Truth: this program's own picture by better settings, since reflections have no other here; errors are "
             "distances from that, and what both get wrong alike is not in them.";
    case TruthKind::Itself:
      return "No truth: times alone are looked at, and errors are distances from pictures by the same settings.";
    case TruthKind::Blender:
      return "Truth: a picture that Blender made for this study, linear radiance of the passes that the view stands "
             "for. "
             "Its direct light holds that of emissive faces, which is indirect light here.";
    case TruthKind::Cycles:
      return "Truth: a picture by Cycles.";
  }
  return "";
}

std::string experimentSection(const fs::path& folder, const ExperimentResult& e) {
  std::string out = fmt::format("<h2>{}</h2>\n", escapeXml(e.experiment.name));
  if (!e.skipped.empty()) return out + fmt::format("<p>Skipped: {}.</p>\n", escapeXml(e.skipped));
  const fs::path own = folder / e.experiment.name;
  const ReportNotes notes = readNotes(own);
  std::vector<std::string> facts = notes.facts;
  facts.emplace_back(truthOf(e.experiment.truth));
  out += htmlList(facts);
  std::vector<PointSummary> points;
  for (const MeasuredPoint& p : e.points) points.push_back(p.summary);
  std::vector<size_t> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  std::erase_if(all, [&](size_t i) { return points[i].seeds == 0; });
  if (points.size() > 1) {
    const CostKind& cost = costKinds().front();
    out += htmlFinding(errorFinding(cost, points, {}, std::nullopt)) + errorPlot(cost, points, {}, std::nullopt);
  }
  for (const auto& [kind, axis, name] : kTimeKinds)
    out += htmlFinding(stageFinding(name, kind, points, all)) + stagePlot(axis, kind, points, all);
  std::string crops = reportCrop(own, kReferenceName, "Truth", notes);
  for (const size_t i : all)
    crops += reportCrop(own, pictureName(points[i].point),
                        fmt::format("{}: relMSE {}", points[i].label, shortNumber(points[i].relMse.mean)), notes);
  if (!crops.empty()) out += "<div class=\"crops\">\n" + crops + "</div>\n";
  std::string tables = pointTables(points, std::nullopt);
  // Headings of a study's own page are one level too high here.
  for (size_t at = 0; (at = tables.find("h2>", at)) != std::string::npos; at += 3) tables[at + 1] = '3';
  out += tables;
  if (e.figures.size() > 1 || (e.figures.size() == 1 && !e.figures.contains("truth_mean"))) {
    TextTable figures{{"also measured", ""}};
    for (const auto& [name, value] : e.figures) figures.push_back({name, plainNumber(value)});
    out += htmlOf(figures);
  }
  return out;
}

std::string fileNameOf(std::string heading) {
  std::string out;
  for (const char c : heading) {
    if (c == ':') break;
    out += c == ' ' ? '-' : static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  }
  return out + ".csv";
}

std::string tableSections(const fs::path& folder, const NamedReport& report) {
  std::string out;
  for (const auto& [heading, table] : report.tables) {
    writeFile(folder / fileNameOf(heading), csvOf(table));
    out += fmt::format("<h2>{}</h2>\n{}", escapeXml(heading), htmlOf(table));
  }
  return out;
}

}  // namespace

TextTable findingsTable(const NamedStudy& study, const NamedResults& results) {
  TextTable out{{"study", "section", "thesis", "here", "verdict"}};
  for (const Claim& claim : study.claims) {
    const Answer answer = answerTo(claim, results);
    out.push_back({study.name, claim.section, claim.said, answer.text, toString(answer.verdict)});
  }
  return out;
}

void writeNamedReport(const fs::path& folder, const NamedReport& report) {
  std::string body;
  if (!report.study->claims.empty()) {
    writeFile(folder / "findings.csv", csvOf(findingsTable(*report.study, report.results)));
    body += findingTable(findingRows(report));
  }
  body += tableSections(folder, report);
  for (const ExperimentResult& e : report.results.experiments) body += experimentSection(folder, e);
  writeFile(folder / "report.html",
            htmlPage(fmt::format("{}: {}", report.study->name, report.study->question), report.facts, body));
}

void writeThesisReport(const fs::path& folder, const std::vector<NamedReport>& reports) {
  TextTable findings{{"study", "section", "thesis", "here", "verdict"}};
  std::string body;
  for (const NamedReport& report : reports) {
    const NamedStudy& study = *report.study;
    const TextTable own = findingsTable(study, report.results);
    findings.insert(findings.end(), own.begin() + 1, own.end());
    body += fmt::format("<h2>{0}: {1}</h2>\n<p><a href=\"{0}/report.html\">Its pictures, plots and points</a></p>\n",
                        escapeXml(study.name), escapeXml(study.question));
    if (!study.claims.empty()) body += findingTable(findingRows(report));
    body += tableSections(folder, report);
  }
  writeFile(folder / "findings.csv", csvOf(findings));
  writeFile(
      folder / "report.html",
      htmlPage("The thesis's questions", reports.empty() ? std::vector<std::string>{} : reports.front().facts, body));
}

}  // namespace irad
