// `irad settings`: the registry of settings, as a table or JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/arguments.h"
#include "app/table.h"
#include "gi/manifest.h"

namespace irad::app {
namespace {

struct Arguments {
  SettingArguments settings;
  bool json = false, values = false;
};

nlohmann::ordered_json registry(const Settings& settings) {
  const std::vector<SettingInfo> infos = settingInfos(settings), cpu = settingInfos(defaultSettings(true)),
                                 gpu = settingInfos(defaultSettings(false));
  const auto typed = [](const SettingInfo& info) {
    return info.kind == "choice" ? nlohmann::ordered_json(info.value) : nlohmann::ordered_json::parse(info.value);
  };
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (size_t i = 0; i < infos.size(); ++i) {
    const SettingInfo& info = infos[i];
    nlohmann::ordered_json row{{"name", info.meta.name},
                               {"kind", info.kind},
                               {"value", typed(info)},
                               {"default", typed(gpu[i])},
                               {"default_cpu", typed(cpu[i])}};
    if (info.kind == "integer" || info.kind == "number") {
      row["min"] = info.meta.min;
      row["max"] = info.meta.max;
      row["unit"] = info.meta.unit;
    }
    if (info.meta.step > 0) row["step"] = info.meta.step;
    if (!info.choices.empty()) row["choices"] = info.choices;
    row["redo"] = EnumNames<Redo>::names.at(static_cast<size_t>(info.meta.redo));
    row["help"] = info.meta.help;
    out.push_back(row);
  }
  return out;
}

std::string table(const Settings& settings) {
  const std::vector<SettingInfo> infos = settingInfos(settings), cpu = settingInfos(defaultSettings(true)),
                                 gpu = settingInfos(defaultSettings(false));
  std::vector<std::vector<std::string>> rows{{"name", "value", "default", "range", "redo", "help"}};
  for (size_t i = 0; i < infos.size(); ++i) {
    const std::string usual =
        cpu[i].value == gpu[i].value ? gpu[i].value : fmt::format("{} (CPU {})", gpu[i].value, cpu[i].value);
    rows.push_back({infos[i].meta.name, infos[i].value, usual, infos[i].range(),
                    EnumNames<Redo>::names.at(static_cast<size_t>(infos[i].meta.redo)), infos[i].meta.help});
  }
  return formatTable(rows);
}

void run(const Arguments& arguments) {
  const Settings settings = arguments.settings.resolve(arguments.settings.readConfig(), /*cpuDevice=*/false);
  if (arguments.values)
    fmt::print("{}\n", settingsFile(settings));
  else if (arguments.json)
    fmt::print("{}\n", registry(settings).dump(2));
  else
    fmt::print("{}", table(settings));
}

}  // namespace

Command settingsCommand() {
  const auto arguments = std::make_shared<Arguments>();
  return {"settings", "List the settings: name, value, range, what they do",
          [arguments](Options& options) {
            arguments->settings.declare(options);
            options.flag("--json", arguments->json, "The registry as JSON");
            options.flag("--values", arguments->values, "The values alone, as JSON that --config takes");
          },
          [arguments] { run(*arguments); }};
}

}  // namespace irad::app
