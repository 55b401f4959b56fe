// --reference: a picture by others, which the views `reference-picture` and `error` show and compare with.
#pragma once

#include <optional>
#include <string>

#include "app/command.h"
#include "app/config.h"
#include "app/progress.h"
#include "gi/picture.h"

namespace irad::app {

/// UsageError where the reference says that it was made from another camera, or is of another view.
void requireSubject(const ReferencePicture& reference, const Camera& camera, View view);

struct ReferenceArgument {
  std::optional<std::string> file;
  void declare(Options& options);
  /// From the option, else from the config (with a note where that file has changed since); none where neither names
  /// one.
  std::optional<ReferencePicture> read(const Config& config, ProgressReport& progress) const;
};

}  // namespace irad::app
