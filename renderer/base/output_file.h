// Files and folders that appear whole or not at all: written under a temporary name in the same folder
// (.NAME.PID.irad-tmp), renamed when complete and on disk. What a killed run leaves there, the next one to write into
// the folder removes.
// Every failure (no such folder, read-only, disk full) is a WorkError that names the final file and the reason.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace irad {

class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();  ///< without commit(): removes what was written
  OutputFile(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  void commit();  ///< to the disk, then under its final name

 private:
  [[noreturn]] void fail(const char* doing, int error);
  std::filesystem::path path_, temporary_;
  std::FILE* file_ = nullptr;
};

/// A new folder PATH.NNN beside others of its name, numbered from 001. Its parents are made.
class OutputFolder {
 public:
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();  ///< without commit(): removes it with what it holds
  OutputFolder(const OutputFolder&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }  ///< where to write until it is committed
  std::filesystem::path commit();  ///< under the first number that is free; returns the folder

 private:
  [[noreturn]] void fail(int error);
  std::filesystem::path path_, temporary_;
  int lock_ = -1;
};

void writeFile(const std::filesystem::path& path, std::string_view text);
void writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
/// A file's bytes; none where it cannot be read.
std::string readFile(const std::filesystem::path& path);
/// Removes a file if there is one.
void removeFile(const std::filesystem::path& path);
/// Makes a folder and its parents, and checks that it can be written into: better to know before the work than after
/// it.
void makeFolder(const std::filesystem::path& path);

/// makeFolder() for the time of some work. Where that leaves nothing behind, because it failed, the folders that were
/// made for it go again: those that hold nothing but such folders, and files with these names, which say no more than
/// what was to come into them.
class MadeFolder {
 public:
  explicit MadeFolder(const std::filesystem::path& path, std::vector<std::string> labels = {});
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;

 private:
  const std::vector<std::string> labels_;
  std::filesystem::path made_;  ///< the uppermost one that was not there; empty: all of them were
};

/// numpy's type strings of the element types that exports use.
template <class T>
struct NpyType;
template <>
struct NpyType<float> {
  static constexpr const char* descr = "<f4";
};
template <>
struct NpyType<double> {
  static constexpr const char* descr = "<f8";
};
template <>
struct NpyType<int32_t> {
  static constexpr const char* descr = "<i4";
};
template <>
struct NpyType<int64_t> {
  static constexpr const char* descr = "<i8";
};
template <>
struct NpyType<uint8_t> {
  static constexpr const char* descr = "|u1";
};

/// A numpy array file, format version 1.0, C order, little-endian; elements may be appended in pieces.
template <class T>
class NpyFile {
 public:
  NpyFile(std::filesystem::path path, std::vector<uint64_t> shape);
  void write(std::span<const T> elements);
  void commit();  ///< the elements written must fill the shape

 private:
  OutputFile file_;
  uint64_t expected_ = 1, written_ = 0;
};

template <class T>
void writeNpy(const std::filesystem::path& path, std::vector<uint64_t> shape, std::span<const T> elements) {
  NpyFile<T> file(path, std::move(shape));
  file.write(elements);
  file.commit();
}

}  // namespace irad
