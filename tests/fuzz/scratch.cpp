#include <fstream>

#include "tests/fuzz/readers.h"
#include "tests/support.h"

namespace irad::fuzz {
namespace {

void write(const std::filesystem::path& path, Bytes bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

/// The temporary folder with the files that seeds refer to.
struct Scratch : test::TemporaryFolder {
  Scratch() {
    uint8_t data[256];
    for (int i = 0; i < 256; ++i) data[i] = static_cast<uint8_t>(i);
    write(path / "data.bin", data);
    std::filesystem::copy_file(test::sourceFolder() / "tests/fuzz/seeds/image/rgb.png", path / "image.png");
  }
};

}  // namespace

std::filesystem::path scratchFile(const char* name, Bytes bytes) {
  static const Scratch folder;
  write(folder.path / name, bytes);
  return folder.path / name;
}

}  // namespace irad::fuzz
