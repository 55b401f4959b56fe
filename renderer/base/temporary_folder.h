// A fresh folder that lasts as long as its object.
#pragma once

#include <filesystem>

namespace irad {

/// Made in the system's folder for temporary files, for this user alone; removed with what is in it. Throws WorkError
/// where it cannot be made.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;
};

}  // namespace irad
