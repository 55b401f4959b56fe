// The user's own presets: settings files in the configuration folder, as --config takes them too.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gi/settings.h"

namespace irad {

class Presets {
 public:
  using Apply = std::function<void(Settings& settings, const std::filesystem::path& file)>;

  Presets() = default;
  /// `apply` reads a settings file over settings that are there, and throws what is wrong with it. No folder: none can
  /// be saved.
  Presets(std::filesystem::path folder, Apply apply);

  const std::vector<std::string>& names() const { return names_; }  ///< sorted
  /// InputError names the file; the settings stay then.
  void apply(Settings& settings, const std::string& name) const;
  /// Returns the file. UsageError where a name is none (letters, digits, spaces, - and _) or a built-in preset's;
  /// WorkError where the file cannot be written.
  std::filesystem::path save(const std::string& name, const Settings& settings);

 private:
  void list();
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".json"); }
  std::filesystem::path folder_;
  Apply apply_;
  std::vector<std::string> names_;
};

}  // namespace irad
