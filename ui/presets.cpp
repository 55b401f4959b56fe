#include "ui/presets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "gi/manifest.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"

namespace irad {

Presets::Presets(std::filesystem::path folder, Apply apply) : folder_(std::move(folder)), apply_(std::move(apply)) {
  list();
}

void Presets::list() {
  names_.clear();
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") names_.push_back(it->path().stem().string());
  std::sort(names_.begin(), names_.end());
}

void Presets::apply(Settings& settings, const std::string& name) const {
  Settings applied = settings;
  apply_(applied, file(name));
  settings = applied;
}

std::filesystem::path Presets::save(const std::string& name, const Settings& settings) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == ' ' || c == '-' || c == '_'; };
  if (name.empty() || name.front() == ' ' || name.back() == ' ' || !std::all_of(name.begin(), name.end(), allowed))
    throw UsageError(fmt::format("preset '{}': a name has letters, digits, spaces, - and _", name));
  const std::vector<std::string> builtIn = presetNames();
  if (std::find(builtIn.begin(), builtIn.end(), name) != builtIn.end())
    throw UsageError(fmt::format("preset '{}': this name is a built-in preset's", name));
  if (folder_.empty()) throw WorkError("no preset can be saved: neither XDG_CONFIG_HOME nor HOME names a folder");
  makeFolder(folder_);
  writeFile(file(name), settingsFile(settings) + "\n");
  list();
  return file(name);
}

}  // namespace irad
