// --reference: a picture by others, which the views `reference-picture` and `error` show and compare with.
#pragma once

#include <optional>
#include <string>

#include "app/command.h"
#include "app/progress.h"
#include "gi/config.h"
#include "gi/picture.h"

namespace irad::app {

/// UsageError where the reference says that it was made from another camera, or is of another view.
void requireSubject(const ReferencePicture& reference, const Camera& camera, View view);

struct ReferenceArgument {
  std::optional<std::string> file;
  void declare(Options& options);
  /// Whether the option or the config names one.
  bool given(const Config& config) const { return file || config.reference; }
  /// From the option, else from the config (with a note where that file has changed since); none where neither names
  /// one.
  std::optional<ReferencePicture> read(const Config& config, ProgressReport& progress) const;
};

/// UsageError where a view that was asked for has nothing to be drawn from: no reference picture, no oracle of the
/// scene (its path).
void requireInput(const ViewInfo& view, bool reference, const std::filesystem::path& scene);
/// UsageError where the reference is not of the pictures' size.
void requireSize(const ReferencePicture& reference, glm::uvec2 size);

}  // namespace irad::app
