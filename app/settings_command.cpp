// `irad settings`: the registry of settings, as a table or JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/arguments.h"
#include "app/table.h"
#include "gi/manifest.h"
#include "renderer/base/console.h"
#include "renderer/base/json_reader.h"

namespace irad::app {
namespace {

struct SettingsArguments {
  SettingArguments settings;
  bool json = false, values = false;
};

nlohmann::ordered_json registry(const Settings& settings) {
  const Settings cpu = defaultSettings(true), gpu = defaultSettings(false);
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Setting& setting : settingTable()) {
    const auto typed = [&](const Settings& of) {
      return setting.kind == SettingKind::choice ? nlohmann::ordered_json(setting.text(of))
                                                 : nlohmann::ordered_json::parse(setting.text(of));
    };
    nlohmann::ordered_json row{{"name", setting.name},
                               {"kind", nameOf(setting.kind)},
                               {"value", typed(settings)},
                               {"default", typed(gpu)},
                               {"default_cpu", typed(cpu)}};
    if (setting.kind == SettingKind::integer || setting.kind == SettingKind::number) {
      row["min"] = setting.range.min;
      row["max"] = setting.range.max;
      row["unit"] = setting.range.unit;
    }
    if (setting.range.step > 0) row["step"] = setting.range.step;
    if (!setting.choices.empty()) row["choices"] = setting.choices;
    row["redo"] = nameOf(setting.redo);
    row["help"] = setting.help;
    out.push_back(row);
  }
  return out;
}

std::string table(const Settings& settings) {
  const Settings cpu = defaultSettings(true), gpu = defaultSettings(false);
  std::vector<std::vector<std::string>> rows{{"name", "value", "default", "range", "redo", "help"}};
  for (const Setting& setting : settingTable()) {
    std::string usual = setting.text(gpu);
    if (setting.get(cpu) != setting.get(gpu)) usual += fmt::format(" (CPU {})", setting.text(cpu));
    rows.push_back(
        {setting.name, setting.text(settings), usual, setting.allowed(), nameOf(setting.redo), setting.help});
  }
  return formatTable(rows);
}

void run(const SettingsArguments& arguments) {
  const Settings settings = arguments.settings.resolve(arguments.settings.readConfig(), /*cpuDevice=*/false);
  if (arguments.values)
    print("{}\n", settingsFile(settings));
  else if (arguments.json)
    print("{}\n", jsonText(registry(settings), 2));
  else
    print("{}", table(settings));
}

}  // namespace

Command settingsCommand() {
  const auto arguments = std::make_shared<SettingsArguments>();
  return {"settings", "List the settings: name, value, range, what they do",
          [arguments](Options& options) {
            arguments->settings.declare(options);
            options.flag("--json", arguments->json, "The registry as JSON");
            options.flag("--values", arguments->values, "The values alone, as JSON that --config takes");
          },
          [arguments](Machine&) { run(*arguments); }};
}

}  // namespace irad::app
