// `irad check`: the catalogue of hard cases on this device.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/arguments.h"
#include "app/device_session.h"
#include "app/devices.h"
#include "app/table.h"
#include "gi/check/check.h"
#include "renderer/base/console.h"
#include "renderer/base/csv.h"
#include "renderer/base/error.h"
#include "renderer/base/json_reader.h"
#include "renderer/base/output_file.h"

namespace irad::app {
namespace {

struct CheckArguments {
  std::vector<std::string> cases;
  std::optional<std::string> seeds, json, csv, markdown;
  bool list = false, quick = false, figures = false;
  SettingArguments settings;
  DeviceArguments device;
};

/// A case's outcome in the default mode and, for comparison, in the thesis's.
struct Result {
  const CheckCase* check;
  CheckOutcome outcome;
  std::optional<CheckOutcome> thesis;
  bool ran = false;
  const char* status() const { return !ran ? "pending" : outcome.passed() ? "pass" : "FAIL"; }
  /// The thesis's value of a figure; NaN where it has none.
  double thesisValue(const std::string& figure) const {
    const CheckFigure* found = thesis ? thesis->find(figure) : nullptr;
    return found != nullptr ? found->value : std::nan("");
  }
  const CheckFigure* decisive() const { return outcome.decisive(thesis ? &*thesis : nullptr); }
};

std::string number(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.6g}", value);
}

std::string figureText(const Result& result, const CheckFigure& figure) {
  std::string text = fmt::format("{} = {}", figure.name, number(figure.value));
  if (!figure.mark.empty()) text += fmt::format("  (mark {})", figure.mark);
  if (const double thesis = result.thesisValue(figure.name); !std::isnan(thesis))
    text += fmt::format("  thesis {}", number(thesis));
  return text;
}

void printCase(const Result& result, bool allFigures) {
  const CheckOutcome& outcome = result.outcome;
  std::string line = fmt::format("{:<8}{:<18}{:>8.0f} ms  ", result.status(), result.check->name, outcome.milliseconds);
  if (!result.ran)
    line += result.check->pending;
  else if (!outcome.error.empty())
    line += outcome.error;
  else if (const CheckFigure* figure = result.decisive())
    line += figureText(result, *figure);
  print("{}\n", line);
  if (allFigures)
    for (const CheckFigure& figure : outcome.figures)
      print("        {} {}\n", figure.passed() ? ' ' : '!', figureText(result, figure));
  flushStandardOutput();
}

void printList() {
  std::vector<std::vector<std::string>> rows{{"case", "set-up", "oracle", "mark"}};
  for (const CheckCase& check : checkCases()) rows.push_back({check.name, check.setup, check.oracle, check.mark});
  print("{}", formatTable(rows));
}

nlohmann::ordered_json toJson(const std::vector<Result>& results, const DeviceInfo& device) {
  nlohmann::ordered_json out{{"device", device.name}, {"driver", device.driver}};
  for (const Result& r : results) {
    nlohmann::ordered_json figures = nlohmann::ordered_json::array();
    const auto value = [](double v) { return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json(); };
    for (const CheckFigure& f : r.outcome.figures)
      figures.push_back({{"name", f.name},
                         {"value", value(f.value)},
                         {"mark", f.mark},
                         {"passed", f.passed()},
                         {"thesis", value(r.thesisValue(f.name))}});
    out["cases"].push_back({{"name", r.check->name},
                            {"setup", r.check->setup},
                            {"oracle", r.check->oracle},
                            {"mark", r.check->mark},
                            {"status", r.status()},
                            {"error", r.outcome.error},
                            {"milliseconds", r.outcome.milliseconds},
                            {"figures", figures}});
  }
  return out;
}

std::string toCsv(const std::vector<Result>& results) {
  std::string out = "case,status,figure,value,mark,passed,thesis,milliseconds\n";
  for (const Result& r : results) {
    if (r.outcome.figures.empty())
      out += fmt::format("{},{},{},,,,,{:.3f}\n", r.check->name, r.status(),
                         csvField(r.ran ? r.outcome.error : r.check->pending), r.outcome.milliseconds);
    for (const CheckFigure& f : r.outcome.figures)
      out += fmt::format("{},{},{},{:.9g},{},{},{},{:.3f}\n", r.check->name, r.status(), csvField(f.name), f.value,
                         csvField(f.mark), f.passed(), number(r.thesisValue(f.name)), r.outcome.milliseconds);
  }
  return out;
}

constexpr std::string_view kTableHead = "| case | figure | ours | mark | | thesis | ms |\n";

/// Text in a cell: a bar would end it.
std::string cell(std::string text) {
  for (size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
  return text;
}

/// The table of docs/stability.md: the decisive figure of each case.
std::string toMarkdown(const std::vector<Result>& results) {
  std::string out(kTableHead);
  out += "|---|---|--:|---|---|--:|--:|\n";
  for (const Result& r : results) {
    const CheckFigure* f = r.decisive();
    if (f == nullptr || !r.outcome.error.empty())
      out += fmt::format("| {} | {} | | | {} | | |\n", r.check->name, r.ran ? r.outcome.error : r.check->pending,
                         r.status());
    else
      out += fmt::format("| {} | {} | {} | {} | {} | {} | {:.0f} |\n", r.check->name, cell(f->name), number(f->value),
                         f->mark, r.status(), number(r.thesisValue(f->name)), r.outcome.milliseconds);
  }
  return out;
}

/// Writes the table in place of the one that the file holds; into a new file otherwise.
void writeMarkdown(const std::string& path, const std::string& table) {
  std::string text = readFile(path);
  const size_t start = text.find(kTableHead);
  if (!text.empty() && start == std::string::npos)
    throw UsageError(fmt::format("--markdown: {} exists and holds no table of hard cases", path));
  size_t end = start;
  while (end != std::string::npos && end < text.size() && text[end] == '|') end = text.find('\n', end) + 1;
  writeFile(path, text.empty() ? table : text.replace(start, end - start, table));
}

void run(const CheckArguments& arguments, Machine& machine) {
  if (arguments.device.list) return printDevices(/*json=*/false);
  if (arguments.list) return printList();
  std::vector<const CheckCase*> chosen;
  for (const std::string& name : arguments.cases) chosen.push_back(&findCheckCase(name));
  if (chosen.empty())
    for (const CheckCase& check : checkCases()) chosen.push_back(&check);

  DeviceSession session(machine, arguments.settings, arguments.device,
                        /*timedFrames=*/1);  // nobody reads them, and soak runs long
  Settings settings = session.settings;
  if (arguments.settings.sizesAreDefault()) applyCheckSizes(settings);
  CheckOptions options{.quick = arguments.quick, .program = machine.program, .scenes = {}};
  if (arguments.seeds) options.seeds = static_cast<uint32_t>(parseInteger("--seeds", *arguments.seeds, 1, 1000));
  for (const std::string& scene : builtInScenes()) options.scenes.push_back(findScene(scene, {}, std::nullopt));
  std::vector<Result> results;
  size_t failed = 0, pending = 0;
  for (const CheckCase* check : chosen) {
    Result result{check, {}, {}};
    // What is known to fail is run where it is asked for by name.
    result.ran = check->run != nullptr && (check->pending == nullptr || !arguments.cases.empty());
    if (result.ran) {
      session.progress(check->name, static_cast<float>(results.size()) / static_cast<float>(chosen.size()));
      result.outcome = runCheck(*session.context, *check, settings, options);
      // Not judged; long cases are shortened.
      CheckOptions beside = options;
      beside.quick = true;
      if (!arguments.quick) result.thesis = runCheck(*session.context, *check, thesisBeside(settings), beside);
      session.progress.finish();
    }
    pending += !result.ran;
    failed += result.ran && !result.outcome.passed();
    printCase(result, arguments.figures);
    results.push_back(std::move(result));
  }
  if (arguments.json) writeFile(*arguments.json, jsonText(toJson(results, session.device->info), 2) + "\n");
  if (arguments.csv) writeFile(*arguments.csv, toCsv(results));
  if (arguments.markdown) writeMarkdown(*arguments.markdown, toMarkdown(results));
  print("{} passed, {} failed{}\n", results.size() - failed - pending, failed,
        pending != 0 ? fmt::format(", {} pending", pending) : "");
  session.checkValidation();
  if (failed != 0) throw WorkError(fmt::format("{} of {} hard cases failed", failed, results.size()));
}

}  // namespace

Command checkCommand() {
  const auto arguments = std::make_shared<CheckArguments>();
  return {"check", "Run the hard cases against their oracles",
          [arguments](Options& options) {
            options.arguments(
                "CASE", arguments->cases,
                "Cases to run (default: all but those that are known to fail, which run where they are named); "
                "`irad check --list` names them");
            options.flag("--list", arguments->list, "List the cases with set-up, oracle and mark");
            options.flag("--quick", arguments->quick,
                         "Without the thesis's figures; fewer frames in long cases, fewer samples in truths");
            options.flag("--figures", arguments->figures, "Every figure of a case, not the decisive one alone");
            options.value("--seeds", "COUNT", arguments->seeds,
                          "Members of each family of scenes (default: 3; with --quick 1)");
            options.value("--json", "FILE", arguments->json, "Write all figures as JSON");
            options.value("--csv", "FILE", arguments->csv, "Write all figures as CSV");
            options.value("--markdown", "FILE", arguments->markdown,
                          "Write the decisive figures as a table, in place of the one in FILE");
            arguments->settings.declare(options);
            arguments->device.declare(options);
          },
          [arguments](Machine& machine) { run(*arguments, machine); }};
}

}  // namespace irad::app
