#include "renderer/base/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "renderer/base/error.h"

namespace irad {

static_assert(std::endian::native == std::endian::little, "the file formats here are little-endian");

namespace {

namespace fs = std::filesystem;

constexpr const char* kTemporary = ".irad-tmp";

/// Removes what killed runs have left in a folder: temporary files and folders that no process holds locked.
void removeLeftovers(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with('.') || !name.ends_with(kTemporary)) continue;
    const int file = ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    std::error_code ignored;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry->path(), ignored);
    ::close(file);
  }
}

/// The process id keeps two runs into one folder apart.
fs::path temporaryName(const fs::path& path) {
  return path.parent_path() / fmt::format(".{}.{}{}", path.filename().string(), ::getpid(), kTemporary);
}

}  // namespace

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  removeLeftovers(path_.parent_path());
  temporary_ = temporaryName(path_);
  // Locked as long as it has this name. Another run may take it for a leftover before it is locked; then it is made
  // again.
  struct stat status {};
  do {
    if (file_) std::fclose(file_);
    file_ = std::fopen(temporary_.c_str(), "wbe");
    if (!file_) fail("create", errno);
    ::flock(::fileno(file_), LOCK_EX);  // fails where the file system has no locks; no leftovers are removed there
  } while (::fstat(::fileno(file_), &status) == 0 && status.st_nlink == 0);
}

OutputFile::~OutputFile() {
  if (file_) std::fclose(file_);
  if (temporary_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void OutputFile::fail(const char* doing, int error) {
  if (file_) std::fclose(file_);
  file_ = nullptr;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  temporary_.clear();
  throw WorkError(fmt::format("cannot {} {}: {}", doing, path_.string(), std::strerror(error)));
}

void OutputFile::write(std::span<const std::byte> bytes) {
  if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("write", errno);
}

void OutputFile::commit() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("write", errno);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail("write", errno);
  temporary_.clear();
  std::fclose(std::exchange(file_, nullptr));  // frees the lock too; everything is on disk already
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)), temporary_(temporaryName(path_)) {
  makeFolder(path_.parent_path());
  removeLeftovers(path_.parent_path());
  // Locked as an OutputFile is.
  struct stat status {};
  do {
    if (lock_ >= 0) ::close(lock_);
    if (::mkdir(temporary_.c_str(), 0777) != 0 && errno != EEXIST) fail(errno);
    lock_ = ::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) fail(errno);
    ::flock(lock_, LOCK_EX);
  } while (::fstat(lock_, &status) == 0 && status.st_nlink == 0);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

void OutputFolder::fail(int error) {
  throw WorkError(fmt::format("cannot create folder {}: {}", path_.string(), std::strerror(error)));
}

fs::path OutputFolder::commit() {
  for (int number = 1;; ++number) {
    const fs::path wanted = fmt::format("{}.{:03}", path_.string(), number);
    // A folder can only replace an empty one.
    if (std::rename(temporary_.c_str(), wanted.c_str()) == 0) {
      temporary_.clear();
      return wanted;
    }
    if (errno != EEXIST && errno != ENOTEMPTY && errno != ENOTDIR) fail(errno);
  }
}

void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}
std::string readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void writeFile(const std::filesystem::path& path, std::string_view text) {
  writeFile(path, std::as_bytes(std::span(text)));
}

void removeFile(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw WorkError(fmt::format("cannot remove {}: {}", path.string(), error.message()));
}

void makeFolder(const std::filesystem::path& path) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error && !std::filesystem::is_directory(path)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw WorkError(fmt::format("cannot create folder {}: {}", path.string(), error.message()));
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    throw WorkError(fmt::format("cannot write into {}: {}", path.string(), std::strerror(errno)));
}

namespace {

/// Whether a folder and those in it hold no file but labels.
bool isEmpty(const fs::path& folder, const std::vector<std::string>& labels) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const bool label = entry->is_regular_file(error) && std::ranges::count(labels, entry->path().filename().string());
    if (!label && (entry->is_symlink(error) || !entry->is_directory(error) || !isEmpty(entry->path(), labels)))
      return false;
  }
  return !error;
}

/// What isEmpty() has found: nothing that another run may have put there since.
void removeEmpty(const fs::path& folder, const std::vector<std::string>& labels) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory(error)) folders.push_back(entry->path());
  for (const fs::path& path : folders) removeEmpty(path, labels);
  for (const std::string& label : labels) fs::remove(folder / label, error);
  fs::remove(folder, error);  // does so where it is empty
}

}  // namespace

MadeFolder::MadeFolder(const fs::path& path, std::vector<std::string> labels) : labels_(std::move(labels)) {
  std::error_code error;
  for (fs::path folder = fs::absolute(path, error).lexically_normal(); !error && !fs::exists(folder, error);
       folder = folder.parent_path()) {
    if (!folder.has_relative_path()) break;
    made_ = folder;
  }
  makeFolder(path);
}

MadeFolder::~MadeFolder() {
  if (!made_.empty() && isEmpty(made_, labels_)) removeEmpty(made_, labels_);
}

template <class T>
NpyFile<T>::NpyFile(std::filesystem::path path, std::vector<uint64_t> shape) : file_(std::move(path)) {
  std::string dimensions;
  for (const uint64_t extent : shape) {
    expected_ *= extent;
    dimensions += fmt::format("{}, ", extent);
  }
  if (shape.size() > 1) dimensions.resize(dimensions.size() - 2);  // (3,) but (3, 4)
  if (shape.size() == 1) dimensions.pop_back();
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", NpyType<T>::descr, dimensions);
  // Magic (6), version (2), length (2), then the dictionary, padded so that the data start at a multiple of 64.
  const size_t unpadded = 10 + header.size() + 1;
  header.append((64 - unpadded % 64) % 64, ' ');
  header += '\n';
  const auto length = static_cast<uint16_t>(header.size());
  file_.write(std::string_view("\x93NUMPY\x01\x00", 8));
  file_.write(std::as_bytes(std::span(&length, 1)));
  file_.write(header);
}

template <class T>
void NpyFile<T>::write(std::span<const T> elements) {
  written_ += elements.size();
  IRAD_CHECK_OP(written_, <=, expected_);
  file_.write(std::as_bytes(elements));
}

template <class T>
void NpyFile<T>::commit() {
  IRAD_CHECK_OP(written_, ==, expected_);
  file_.commit();
}

template class NpyFile<double>;
template class NpyFile<float>;
template class NpyFile<int32_t>;
template class NpyFile<int64_t>;
template class NpyFile<uint8_t>;

}  // namespace irad
