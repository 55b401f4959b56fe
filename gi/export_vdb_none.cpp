// Builds without OpenVDB.
#include "gi/export.h"
#include "renderer/base/error.h"

namespace irad {

bool canWriteVdb() {
  return false;
}

std::filesystem::path writeVolumeVdb(const VolumeValues&, glm::dvec3, const std::filesystem::path&) {
  throw WorkError("this build has no OpenVDB (IRAD_VDB)");
}

}  // namespace irad
