// Volumes as OpenVDB files: the one translation unit that knows the library (the longest to compile).
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <sstream>

#include "gi/export.h"
#include "gi/grid.h"
#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/base/sha256.h"

namespace irad {
namespace {

const char* unitOf(Volume volume) {
  switch (volume) {
    case Volume::radiosity:
    case Volume::irradiance:
    case Volume::emission:
      return "W/m^2";
    case Volume::distance:
      return "voxels";
    case Volume::albedo:
    case Volume::normal:
      return "1";
  }
  return "";
}

float value(const VolumeValues& volume, size_t voxel, float) {
  return volume.values[voxel];
}
openvdb::Vec3s value(const VolumeValues& volume, size_t voxel, const openvdb::Vec3s&) {
  return openvdb::Vec3s(&volume.values[3 * voxel]);
}

template <class VdbGrid>
typename VdbGrid::Ptr makeGrid(const VolumeValues& volume, bool dense) {
  const typename VdbGrid::ValueType zero{0.0f};
  const auto grid = VdbGrid::create(zero);
  auto accessor = grid->getAccessor();
  for (uint32_t v = 0; v < volume.grid.voxels; ++v) {
    if (!dense && !volume.solid[v]) continue;
    const glm::ivec3 at(voxelOf(v, volume.grid.dims));
    accessor.setValue(openvdb::Coord(at.x, at.y, at.z), value(volume, v, zero));
  }
  return grid;
}

openvdb::GridBase::Ptr makeGrid(const VolumeValues& volume) {
  if (volume.channels == 1) return makeGrid<openvdb::FloatGrid>(volume, /*dense=*/true);
  const openvdb::Vec3SGrid::Ptr grid = makeGrid<openvdb::Vec3SGrid>(volume, /*dense=*/false);
  const bool normal = volume.volume == Volume::normal;
  grid->setVectorType(normal ? openvdb::VEC_COVARIANT_NORMALIZE : openvdb::VEC_INVARIANT);
  if (!normal) grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

/// The file's header ends in a random UUID. Made from the contents instead, it tells files apart as well, and the same
/// contents are the same file.
void nameByContents(std::string& file) {
  // Magic (8 bytes), file version (4), library version (2 x 4), "has grid offsets" (1); then 36 characters.
  constexpr size_t start = 21, dashes[] = {8, 13, 18, 23}, length = 36;
  IRAD_CHECK(file.size() > start + length && file[start + 8] == '-' && file[start + 23] == '-',
             "OpenVDB's header is not what it was");
  std::fill_n(file.begin() + start, length, '0');
  std::string uuid = sha256({reinterpret_cast<const uint8_t*>(file.data()), file.size()}).substr(0, 32);
  for (const size_t at : dashes) uuid.insert(at, "-");
  file.replace(start, length, uuid);
}

}  // namespace

bool canWriteVdb() {
  return true;
}

std::filesystem::path writeVolumeVdb(const VolumeValues& volume, glm::dvec3 sceneOrigin,
                                     const std::filesystem::path& folder) {
  openvdb::initialize();
  const char* name = nameOf(volume.volume);
  const double edge = volume.grid.edge;
  const glm::dvec3 center = sceneOrigin + glm::dvec3(volume.grid.origin) + 0.5 * edge;  // of voxel (0, 0, 0)
  const openvdb::GridBase::Ptr grid = makeGrid(volume);
  grid->setName(name);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(edge));
  grid->transform().postTranslate({center.x, center.y, center.z});
  grid->insertMeta("unit", openvdb::StringMetadata(unitOf(volume.volume)));
  grid->setCreator("irad");

  std::ostringstream stream;
  openvdb::io::Stream(stream).write({grid});
  std::string file = std::move(stream).str();
  nameByContents(file);
  const std::filesystem::path path = folder / (std::string(name) + ".vdb");
  writeFile(path, file);
  return path;
}

}  // namespace irad
