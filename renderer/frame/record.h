// Buffers that hold the addresses of others.
#pragma once

#include "renderer/frame/frame.h"

namespace irad {

/// Makes a record, and gives out the addresses that it is to hold. The record brings the buffers behind them: a pass
/// that takes the record's address reads them all. They must outlive what the record is used for.
class RecordMaker {
 public:
  RecordMaker(Context& context, std::string name, SubsystemName subsystem, uint64_t bytes);
  uint64_t of(const Buffer& buffer);
  uint64_t own(uint64_t offset) const;  ///< address of a place within the record itself
  Buffer make(std::span<const std::byte> contents);
  template <class T>
  requires std::is_trivially_copyable_v<T> &&(!std::is_convertible_v<T, std::span<const std::byte>>)Buffer
      make(const T& contents) {
    return make(std::as_bytes(std::span(&contents, 1)));
  }

 private:
  Context& context_;
  Buffer record_;
};

}  // namespace irad
