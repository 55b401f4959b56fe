// What the split of an error looks like: CSV, bars, table, page.
#include <fmt/format.h>

#include <cmath>

#include "gi/study/attribution.h"
#include "gi/study/html.h"
#include "gi/study/plot.h"
#include "renderer/base/csv.h"
#include "renderer/base/number_text.h"

namespace irad {
namespace {

std::string csvValue(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}
std::string csvCost(double value) {
  return fmt::format("{:.4f}", value);
}
std::string withHalf(const MeanInterval& m) {
  return std::isfinite(m.half) ? fmt::format("{} ± {}", plainNumber(m.mean), plainNumber(m.half)) : plainNumber(m.mean);
}

/// The measured stages, and a function of each as a bar's part.
template <class Part>
Bar barOf(const Attribution& a, const std::string& label, Part&& part) {
  Bar bar{label, {}};
  for (const StageError& row : a.stages)
    if (row.presence.present) bar.parts.push_back(part(row));
  return bar;
}
std::vector<std::string> presentNames(const Attribution& a) {
  std::vector<std::string> out;
  for (const StageError& row : a.stages)
    if (row.presence.present) out.emplace_back(nameOf(row.stage));
  return out;
}

}  // namespace

std::string attributionCsv(const Attribution& a) {
  std::string out =
      "row,words,relmse,relmse_ci95,ideal_relmse,ideal_relmse_ci95,gain,gain_ci95,share,chain_relmse,chain_relmse_ci95,"
      "chain_step,chain_step_ci95,chain_squared,chain_mean_difference,build_ms,relight_ms,frame_ms,mib\n";
  const auto pair = [](const MeanInterval& m) { return fmt::format("{},{}", csvValue(m.mean), csvValue(m.half)); };
  const auto costs = [](const StageCost& c) {
    return fmt::format("{},{},{},{}", csvCost(c.buildMs), csvCost(c.relightMs), csvCost(c.frameMs), csvCost(c.mib));
  };
  StageCost all = a.other;
  for (const StageError& row : a.stages)
    all.buildMs += row.cost.buildMs, all.relightMs += row.cost.relightMs, all.frameMs += row.cost.frameMs,
        all.mib += row.cost.mib;
  out += fmt::format("picture,{},{},,,,,1,,,,,,,{}\n", csvField("the picture as it is"), pair(a.asIs), costs(all));
  out += fmt::format("model,{},{},,,,,{},{},{},{},{},,,,\n", csvField("every stage ideal, against the truth"),
                     pair(a.model), csvValue(a.asIs.mean != 0 ? a.model.mean / a.asIs.mean : 0), pair(a.model),
                     pair(a.model), csvValue(a.model.mean), csvValue(a.modelDifference));
  for (const StageError& row : a.stages) {
    out += fmt::format("{},{},{},", nameOf(row.stage), csvField(row.presence.words), pair(a.asIs));
    if (row.presence.present)
      out += fmt::format("{},{},{},{},{},{},{}", pair(row.ideal), pair(row.gain), csvValue(row.share), pair(row.error),
                         pair(row.step), csvValue(row.squared), csvValue(row.difference));
    else
      out += ",,,,,,,,,,";
    out += "," + costs(row.cost) + "\n";
  }
  if (a.hasRaysBias) {
    const auto part = [&](const char* name, const char* words, const MeanInterval& m) {
      out += fmt::format("{},{},{},,,{},{},,,,,,,,,,\n", name, csvField(words), pair(a.asIs), pair(m),
                         csvValue(a.asIs.mean != 0 ? m.mean / a.asIs.mean : 0));
    };
    part("rays.variance", "of rays: what the seeds scatter by", a.variance);
    part("rays.bias", "of rays: what the mean over the seeds loses by more rays", a.raysBias);
  }
  out += fmt::format("other,{},,,,,,,,,,,,,,{}\n", csvField("time and memory of no stage alone"), costs(a.other));
  out += fmt::format("rest,{},{},,,{},,{},,,,,{},,,,,\n",
                     csvField("relMSE less the sum of gains, and of squared differences along the chain"), pair(a.asIs),
                     csvValue(a.restOfGains), csvValue(a.asIs.mean != 0 ? a.restOfGains / a.asIs.mean : 0),
                     csvValue(a.restOfSquares));
  return out;
}

std::string errorBars(const Attribution& a) {
  std::vector<std::string> names = presentNames(a);
  names.emplace_back("model");
  names.emplace_back("rest");
  Bar alone = barOf(a, "one left out at a time", [](const StageError& row) { return row.gain.mean; });
  alone.parts.insert(alone.parts.end(), {0.0, a.restOfGains});
  Bar chain = barOf(a, "along the chain", [](const StageError& row) { return row.step.mean; });
  chain.parts.insert(chain.parts.end(), {a.model.mean, 0.0});
  Bar squares = barOf(a, "squares along the chain", [](const StageError& row) { return row.squared; });
  squares.parts.insert(squares.parts.end(), {a.model.mean, a.restOfSquares});
  return stackedBars("relMSE of 8 × 8 means", names, {alone, chain, squares}, "relMSE");
}

std::string timeBars(const Attribution& a) {
  std::vector<std::string> names;
  for (const StageError& row : a.stages) names.emplace_back(nameOf(row.stage));
  names.emplace_back("other");
  const auto bar = [&](const char* label, double StageCost::*member) {
    Bar out{label, {}};
    for (const StageError& row : a.stages) out.parts.push_back(row.cost.*member);
    out.parts.push_back(a.other.*member);
    return out;
  };
  // Those without a time of their own would only fill the legend.
  std::vector<Bar> bars{bar("build", &StageCost::buildMs), bar("relight", &StageCost::relightMs),
                        bar("frame", &StageCost::frameMs)};
  for (size_t i = names.size(); i-- > 0;) {
    double sum = 0;
    for (const Bar& b : bars) sum += b.parts[i];
    if (sum > 0) continue;
    names.erase(names.begin() + static_cast<std::ptrdiff_t>(i));
    for (Bar& b : bars) b.parts.erase(b.parts.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return stackedBars("ms", names, bars);
}

std::string timeFinding(const Attribution& a) {
  const StageError* worst = nullptr;
  for (const StageError& row : a.stages)
    if (row.presence.present && (!worst || row.gain.mean > worst->gain.mean)) worst = &row;
  std::string out;
  double ofWorst = 0, ofAll = 0;
  for (const auto& [name, member] :
       {std::pair("Build", &StageCost::buildMs), {"Relight", &StageCost::relightMs}, {"Frame", &StageCost::frameMs}}) {
    double all = a.other.*member, most = all;
    const char* largest = "of no stage alone";
    for (const StageError& row : a.stages) {
      const double ms = row.cost.*member;
      all += ms;
      if (ms > most) most = ms, largest = nameOf(row.stage);
    }
    if (!(all > 0)) continue;
    ofAll += all;
    if (worst) ofWorst += worst->cost.*member;
    out += fmt::format("{}{}: {} ms, {:.0f} % of it {}.", out.empty() ? "" : " ", name, milliseconds(all),
                       100 * most / all, largest);
  }
  if (out.empty()) return "Nothing was timed.";
  if (worst && worst->gain.mean > 0)
    out += fmt::format(
        " The stage whose ideal gains most, {} ({:.0f} % of the error), has {:.0f} % of these milliseconds.",
        nameOf(worst->stage), 100 * worst->share, 100 * ofWorst / ofAll);
  return out;
}

std::vector<std::vector<std::string>> attributionTable(const Attribution& a) {
  std::vector<std::vector<std::string>> rows{{"stage", "relMSE, ideal", "gain", "share", "chain: relMSE", "step",
                                              "squared", "mean diff.", "build ms", "relight ms", "frame ms", "MiB",
                                              ""}};
  const auto cost = [](std::vector<std::string>& row, const StageCost& c) {
    for (const double ms : {c.buildMs, c.relightMs, c.frameMs}) row.push_back(ms > 0 ? milliseconds(ms) : "-");
    row.push_back(c.mib > 0 ? fmt::format("{:.2f}", c.mib) : "-");
  };
  rows.push_back({"model", "-", "-", "-", withHalf(a.model), plainNumber(a.model.mean), plainNumber(a.model.mean),
                  fmt::format("{:+.2g}", a.modelDifference), "-", "-", "-", "-", "every stage ideal"});
  for (const StageError& row : a.stages) {
    std::vector<std::string> line{nameOf(row.stage)};
    if (row.presence.present)
      for (const std::string& cell :
           {withHalf(row.ideal), withHalf(row.gain), fmt::format("{:.1f} %", 100 * row.share), withHalf(row.error),
            plainNumber(row.step.mean), plainNumber(row.squared), fmt::format("{:+.2g}", row.difference)})
        line.push_back(cell);
    else
      line.insert(line.end(), 7, "-");
    cost(line, row.cost);
    line.push_back(row.presence.words);
    rows.push_back(std::move(line));
  }
  std::vector<std::string> other{"other", "-", "-", "-", "-", "-", "-", "-"};
  cost(other, a.other);
  other.emplace_back("of no stage alone");
  rows.push_back(std::move(other));
  rows.push_back({"rest", "-", plainNumber(a.restOfGains),
                  fmt::format("{:.1f} %", a.asIs.mean != 0 ? 100 * a.restOfGains / a.asIs.mean : 0), "-", "-",
                  plainNumber(a.restOfSquares), "-", "-", "-", "-", "-", "what the sums lack"});
  return rows;
}

std::string attributionReport(const Attribution& a, const std::vector<std::string>& facts,
                              const std::filesystem::path& folder, glm::uvec2 pictureSize,
                              const std::vector<std::pair<std::string, std::string>>& pictures) {
  std::string html = "<h2>What the error comes from</h2>\n";
  for (const std::string& finding : a.findings) html += htmlFinding(finding);
  html += errorBars(a);
  html +=
      "<p class=\"finding\">Parts below 0 are not drawn. <i>Left out</i>: relMSE as it is less that with one stage "
      "ideal. <i>Along the chain</i>: what each stage adds when its error is put back, from all ideal on. "
      "<i>Squares</i>: squared differences of neighbouring pictures of the chain, weighted as relMSE is.</p>\n";
  html += "<h2>What the stages cost</h2>\n" + htmlFinding(timeFinding(a)) + timeBars(a);
  html += "<h2>All figures</h2>\n<table>\n";
  bool head = true;
  for (const std::vector<std::string>& row : attributionTable(a)) {
    html += "<tr>";
    for (size_t i = 0; i < row.size(); ++i) {
      const bool words = i + 1 == row.size();
      const char* look = words    ? " class=\"name\" style=\"white-space:normal;min-width:240px\""
                         : i == 0 ? " class=\"name\""
                                  : "";
      html += fmt::format("<{0}{1}>{2}</{0}>", head ? "th" : "td", look, escapeXml(row[i] == "-" ? "–" : row[i]));
    }
    html += "</tr>\n";
    head = false;
  }
  html += "</table>\n<h2>Pictures</h2>\n<div class=\"crops\">\n";
  for (const auto& [name, caption] : pictures)
    html += htmlFigure(folder / "pictures" / name, {pictureSize, {0, 0}, pictureSize}, caption);
  html += "</div>\n";
  return htmlPage("Where the error comes from", facts, html);
}

}  // namespace irad
